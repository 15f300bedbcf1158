// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/meshes/files/label_files.hpp>
#include <plica/meshes/files/reading.hpp>
#include <string_view>

/// Functions that the parsers of images share.
namespace plica {

/// Heading of an image file: all but the values of its voxels.
struct ImageHeading {
  LabelFile file;                           ///< without labels
  std::array<std::int64_t, 3> size = {};    ///< voxels along i, j, k
  NumberType type = NumberType::uint8;      ///< kind of the values
  std::endian order = std::endian::native;  ///< order of the values' bytes
  double slope = 1, shift = 0;              ///< a label is slope value + shift
};

/// Returns the number of voxels. Throws InputError for sizes below 1 and more voxels than an int
/// has room for, for a place or axis that is not finite, and for axes in one plane.
std::size_t checked_voxels(const ImageHeading& heading, const std::string& file);

/// Returns the image with its labels, which are the next numbers.
LabelFile with_labels(ImageHeading heading, Numbers& numbers);

/// Returns the image with its labels from bytes. Throws InputError where these are not as many as
/// the voxels have.
/// @param first  place of the bytes in the file, or where their compressed form is
LabelFile with_labels(ImageHeading heading, const std::string& file, std::string_view bytes,
                      Place first);

/// Returns what is compressed in gzip's or zlib's format. Throws InputError for broken or cut data,
/// and for more than `most` bytes.
std::string inflated(std::string_view bytes, std::size_t most, const std::string& file);

/// Returns the words of a list between blanks, commas and parentheses.
std::vector<std::string_view> list_words(std::string_view text);

/// Returns `count` numbers of such a list. Throws InputError with the name of the field.
std::vector<double> list_numbers(std::string_view text, std::size_t count, const std::string& field,
                                 const std::string& file, const Place& place);

/// Returns the metres per unit of that name; 0 for an unknown one.
double metres_per(std::string_view unit);

LabelFile parse_nrrd(const FileBytes& file);       ///< see read_labels()
LabelFile parse_nifti(const FileBytes& file);      ///< see read_labels()
LabelFile parse_metaimage(const FileBytes& file);  ///< see read_labels()
LabelFile parse_vtk_image(const FileBytes& file);  ///< see read_labels()

}  // namespace plica
