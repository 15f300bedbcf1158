// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <bit>
#include <plica/meshes/files/base64.hpp>
#include <plica/meshes/files/vtu_out.hpp>
#include <plica/meshes/files/writing.hpp>

namespace plica {

// An array's length in bytes and its numbers are encoded together. The length and the first byte
// fill groups of three bytes, so the rest goes on where they end.
std::string VtuOut::add(const char* type, std::string_view name, int components, const void* data,
                        std::size_t size) {
  TextOut tag;
  tag << "<DataArray type=\"" << type << "\" Name=\"" << name << "\" NumberOfComponents=\""
      << components << "\" format=\"appended\" offset=\"" << arrays_.size() << "\"/>\n";
  const std::string_view bytes(static_cast<const char*>(data), size);
  const std::size_t first = std::min<std::size_t>(size, 1);
  const std::uint64_t length = size;
  std::string head(reinterpret_cast<const char*>(&length), sizeof length);
  append_base64(arrays_, head.append(bytes, 0, first));
  append_base64(arrays_, bytes.substr(first));
  return tag.take();
}

std::string VtuOut::file(std::string_view grid) {
  TextOut head;
  head
      << "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\""
      << (std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian")
      << "\" header_type=\"UInt64\">\n<UnstructuredGrid>\n"
      << grid << "</UnstructuredGrid>\n<AppendedData encoding=\"base64\">\n_";
  arrays_.insert(0, head.take());  // saves the copy of a large text
  return std::move(arrays_ += "\n</AppendedData>\n</VTKFile>\n");
}

}  // namespace plica
