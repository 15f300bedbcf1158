// SPDX-License-Identifier: BSD-3-Clause
#include <plica/meshes/files/image_parts.hpp>

namespace plica {

namespace {

bool is_nifti(std::string_view bytes) {
  constexpr std::string_view lengths[] = {{"\x5c\x01\0\0", 4},
                                          {"\0\0\x01\x5c", 4},  // 348
                                          {"\x1c\x02\0\0", 4},
                                          {"\0\0\x02\x1c", 4}};  // 540
  for (const std::string_view length : lengths)
    if (bytes.starts_with(length)) return true;
  return bytes.starts_with("\x1f\x8b");
}

bool is_metaimage(std::string_view head) {
  return head.starts_with("objecttype") || head.starts_with("ndims");
}

bool is_vtk_image(std::string_view head) {
  return head.starts_with("# vtk datafile") &&
         head.find("structured_points") != std::string_view::npos;
}

std::string head_of(const FileBytes& file) {
  constexpr std::size_t longest = 512;
  return lower_case(std::string_view(file.bytes).substr(0, longest));
}

}  // namespace

bool is_image(const FileBytes& file) {
  const std::string head = head_of(file);
  return head.starts_with("nrrd") || is_nifti(file.bytes) || is_metaimage(head) ||
         is_vtk_image(head);
}

LabelFile read_labels(const FileBytes& file) {
  const std::string head = head_of(file);
  if (head.starts_with("nrrd")) return parse_nrrd(file);
  if (is_nifti(file.bytes)) return parse_nifti(file);
  if (is_metaimage(head)) return parse_metaimage(file);
  if (is_vtk_image(head)) return parse_vtk_image(file);
  refuse(file.name, {},
         "is no image of labels; expected NRRD, NIfTI-1, MetaImage or VTK's STRUCTURED_POINTS");
}

}  // namespace plica
