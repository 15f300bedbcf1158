// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/meshes/files/file_bytes.hpp>
#include <plica/meshes/label_image.hpp>
#include <string>

namespace plica {

/// Image of labels that was read from a file.
struct LabelFile {
  LabelImage image;           ///< lengths in the file's unit
  std::string format;         ///< like "NIfTI-1"
  double unit = 0;            ///< metres per unit of the lengths; 0: unknown
  bool unit_is_said = false;  ///< false: `unit` is what files of this format usually have
};

/// Returns whether the content of a file is an image of voxels in a format of read_labels(). A file
/// that is compressed by gzip is taken for one.
bool is_image(const FileBytes& file);

/// Reads labels of voxels. Formats are NRRD (raw, gzip, text; its definition of format), NIfTI-1 in
/// one file, also compressed by gzip (nifti1.h), MetaImage with its data in the file (raw, zlib),
/// and STRUCTURED_POINTS in VTK's legacy format ("VTK file formats"). Byte orders and the types of
/// numbers are those of the format; real numbers must be integral. Coordinates are those of the
/// file, along whichever axes of the patient it has them.
///
/// @throw InputError for another format, what is malformed, cut short or of another size, an image
/// that is not of three dimensions, and values that are no labels: not integral, below 0, or with
/// more than 1000 different ones
LabelFile read_labels(const FileBytes& file);

}  // namespace plica
