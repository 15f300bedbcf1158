// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <bit>
#include <functional>
#include <map>
#include <optional>
#include <plica/meshes/files/reading.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace plica {

/// How many characters encode so many bytes (RFC 4648, with padding).
constexpr std::size_t base64_size(std::size_t bytes) { return (bytes + 2) / 3 * 4; }

/// The bytes that the characters encode; nothing when they are not whole groups of four from the
/// alphabet, the last one filled up with '='.
std::optional<std::string> decode_base64(std::string_view text);

/// An element of the XML of a VTU file, and the text between its start tag and the next tag.
struct XmlElement {
  std::string name;
  std::string parent;  ///< the name of the element around it; empty: none
  std::map<std::string, std::string> attributes;
  Place place;
  std::size_t text_begin = 0;  ///< bytes
  std::size_t text_end = 0;
  std::int64_t text_line = 0;  ///< where it begins
};

/// The elements in the file's order. Appended data may be no XML, so the parser (pugixml) sees the
/// file up to <AppendedData>; what follows is VtuArrays' to check. InputError with the line for
/// malformed XML, document types and CDATA.
std::vector<XmlElement> vtu_elements(const MemoryFile& file);

/// The numbers of a <DataArray>, wherever and however the file stores them.
class VtuArrays {
 public:
  explicit VtuArrays(const MemoryFile& file) : file_(file) {}

  /// From <VTKFile>: order of bytes, type of the lengths, and how arrays that are not text are
  /// compressed.
  void header(const XmlElement& element);
  /// <AppendedData>: the rest of the file is checked, and kept for arrays that are in it.
  void appended(const XmlElement& element);

  /// Lets `take` take all numbers of an array, of its `type`; nothing may be left of them.
  void read(const XmlElement& array,
            const std::function<void(Numbers& numbers, NumberType type)>& take) const;

 private:
  using Take = std::function<void(Numbers& numbers, NumberType type)>;
  void read_ascii(const XmlElement& array, NumberType type, const Take& take) const;
  void read_bytes(std::string_view bytes, const Place& place, NumberType type,
                  const Take& take) const;
  void read_compressed(std::string_view text, bool base64, const XmlElement& array,
                       const Place& place, NumberType type, const Take& take) const;
  std::string decoded(std::string_view text, bool exactly, const Place& place) const;
  std::string_view appended_at(const XmlElement& array) const;
  std::uint64_t length(std::string_view bytes, const Place& place) const;

  const MemoryFile& file_;
  std::endian order_ = std::endian::little;
  NumberType length_type_ = NumberType::uint32;
  std::string compressor_;  // its name; empty: none
  bool has_appended_ = false, raw_ = false;
  std::size_t begin_ = 0, end_ = 0;  // of the appended data
};

/// An attribute; InputError when there is none.
const std::string& attribute(const XmlElement& element, const std::string& key,
                             const MemoryFile& file);
/// The same as an integer from 0.
std::int64_t attribute_count(const XmlElement& element, const std::string& key,
                             const MemoryFile& file);
NumberType vtu_type(const XmlElement& array, const MemoryFile& file);

}  // namespace plica
