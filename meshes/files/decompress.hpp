// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <optional>
#include <string>
#include <string_view>

namespace plica {

/// A way in which VTK compresses blocks of arrays.
struct Compressor {
  const char* name;           ///< as files have it
  std::size_t largest_ratio;  ///< of what comes out to what goes in: more is a lie
  /// The `size` bytes that a block holds; nothing when it does not.
  std::optional<std::string> (*decompress)(std::string_view block, std::size_t size);
};

/// The one of that name; null for none.
const Compressor* find_compressor(std::string_view name);

/// Their names, "A and B".
std::string compressor_names();

}  // namespace plica
