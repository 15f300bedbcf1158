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

/// XML element of a VTU file, and the text between its start tag and the next tag.
struct XmlElement {
  std::string name;
  std::string parent;  ///< name of the element around it; empty: none
  std::map<std::string, std::string> attributes;
  Place place;
  std::size_t text_begin = 0;  ///< first byte of the text in the file
  std::size_t text_end = 0;    ///< byte after the text
  std::int64_t text_line = 0;  ///< line in which the text begins
};

/// Returns the elements in the file's order. Appended data may be no XML, so the parser (pugixml)
/// gets the file up to <AppendedData> only; VtuArrays checks the rest. Throws an InputError with
/// the line for malformed XML, document types and CDATA.
std::vector<XmlElement> vtu_elements(const FileBytes& file);

/// Reader of the numbers of a <DataArray>, in all forms in which a file stores them.
class VtuArrays {
 public:
  explicit VtuArrays(const FileBytes& file) : file_(file) {}

  /// Reads the attributes of <VTKFile>: byte order, type of the lengths, and compression of arrays
  /// that are not text.
  void header(const XmlElement& element);
  /// Checks the rest of the file after <AppendedData>, and notes where its arrays are.
  void appended(const XmlElement& element);

  /// Calls take(numbers, type) for the numbers of an array. It must read all of them.
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

  const FileBytes& file_;
  std::endian order_ = std::endian::little;
  NumberType length_type_ = NumberType::uint32;
  std::string compressor_;  // name of the compressor; empty: none
  bool has_appended_ = false, raw_ = false;
  std::size_t begin_ = 0, end_ = 0;  // bytes [begin_, end_) of the appended data
};

/// Returns an attribute; throws an InputError if there is none.
const std::string& attribute(const XmlElement& element, const std::string& key,
                             const FileBytes& file);
/// Returns an attribute as an integer; throws an InputError if it is missing, no integer or below
/// 0.
std::int64_t attribute_count(const XmlElement& element, const std::string& key,
                             const FileBytes& file);
/// Returns the type of the numbers of an array; throws an InputError with the choices if the
/// attribute "type" is missing or unknown.
NumberType vtu_type(const XmlElement& array, const FileBytes& file);

}  // namespace plica
