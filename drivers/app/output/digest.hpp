// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <type_traits>
#include <vector>

namespace plica::app {

/// FNV-1a with eight bytes at a time: tells damage and change, not malice. http://www.isthe.com/chongo/tech/comp/fnv/
class Digest {
 public:
  void add(const void* data, std::size_t size) {
    const auto* from = static_cast<const unsigned char*>(data);
    for (std::size_t at = 0; at < size; at += sizeof(std::uint64_t)) {
      std::uint64_t word = 0;
      std::memcpy(&word, from + at, std::min(sizeof word, size - at));
      value_ = (value_ ^ word) * 0x100000001b3ULL;
    }
  }
  template <class T>
  void add(const std::vector<T>& values) {
    static_assert(std::is_trivially_copyable_v<T>);
    add_size(values.size());
    add(values.data(), values.size() * sizeof(T));
  }
  void add(std::string_view text) {
    add_size(text.size());
    add(text.data(), text.size());
  }
  std::uint64_t value() const { return value_; }

 private:
  void add_size(std::uint64_t size) { add(&size, sizeof size); }
  std::uint64_t value_ = 0xcbf29ce484222325ULL;
};

}  // namespace plica::app
