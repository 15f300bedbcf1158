// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <bit>
#include <functional>
#include <plica/meshes/numbers.hpp>
#include <plica/meshes/vtk/xml_tags.hpp>
#include <string>

namespace plica {

/// The numbers of a <DataArray>, wherever and however the file stores them.
class VtuArrays {
 public:
  explicit VtuArrays(const MemoryFile& file) : file_(file) {}

  /// From <VTKFile>: order of bytes, type of the lengths; InputError if the arrays are compressed.
  void header(const XmlElement& element);
  /// <AppendedData> begins. Returns whether raw data follow, which are no XML; then the rest of the file is checked.
  bool appended(const XmlElement& element);

  /// Lets `take` take all numbers of an array, of its `type`; nothing may be left of them.
  void read(const XmlElement& array, const std::function<void(Numbers& numbers, NumberType type)>& take) const;

 private:
  using Take = std::function<void(Numbers& numbers, NumberType type)>;
  void read_ascii(const XmlElement& array, NumberType type, const Take& take) const;
  void read_bytes(std::string_view bytes, const Place& place, NumberType type, const Take& take) const;
  std::string decoded(std::string_view text, bool exactly, const Place& place) const;
  std::string_view appended_at(const XmlElement& array) const;
  std::uint64_t length(std::string_view bytes, const Place& place) const;

  const MemoryFile& file_;
  std::endian order_ = std::endian::little;
  NumberType length_type_ = NumberType::uint32;
  bool has_appended_ = false, raw_ = false;
  std::size_t begin_ = 0, end_ = 0;  // of the appended data
};

/// An attribute; InputError when there is none.
const std::string& attribute(const XmlElement& element, const std::string& key, const MemoryFile& file);
/// The same as an integer from 0.
std::int64_t attribute_count(const XmlElement& element, const std::string& key, const MemoryFile& file);
NumberType vtu_type(const XmlElement& array, const MemoryFile& file);

}  // namespace plica
