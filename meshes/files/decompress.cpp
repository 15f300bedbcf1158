// SPDX-License-Identifier: BSD-3-Clause
#include <lz4.h>
#include <zlib.h>

#include <limits>
#include <plica/meshes/files/decompress.hpp>

namespace plica {

namespace {

std::optional<std::string> by_zlib(std::string_view block, std::size_t size) {
  std::string bytes(size, '\0');
  uLongf length = size;
  const int result = uncompress(reinterpret_cast<Bytef*>(bytes.data()), &length,
                                reinterpret_cast<const Bytef*>(block.data()), block.size());
  if (result != Z_OK || length != size) return {};
  return bytes;
}

std::optional<std::string> by_lz4(std::string_view block, std::size_t size) {
  constexpr std::size_t most = std::numeric_limits<int>::max();
  if (size > most || block.size() > most) return {};
  std::string bytes(size, '\0');
  const int length =
      LZ4_decompress_safe(block.data(), bytes.data(), static_cast<int>(block.size()), static_cast<int>(size));
  if (length < 0 || static_cast<std::size_t>(length) != size) return {};
  return bytes;
}

constexpr Compressor compressors[] = {{"vtkZLibDataCompressor", 1100, by_zlib}, {"vtkLZ4DataCompressor", 260, by_lz4}};

}  // namespace

const Compressor* find_compressor(std::string_view name) {
  for (const Compressor& one : compressors)
    if (name == one.name) return &one;
  return nullptr;
}

std::string compressor_names() {
  std::string names;
  for (const Compressor& one : compressors) names += (names.empty() ? "" : " and ") + std::string(one.name);
  return names;
}

}  // namespace plica
