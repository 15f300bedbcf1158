// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <plica/core/text.hpp>
#include <plica/meshes/files/image_parts.hpp>

namespace plica {

namespace {

constexpr std::size_t heading_bytes = 352;  // with the four bytes about extensions
constexpr std::size_t most_bytes = std::size_t{1} << 33;

struct NiftiType {
  std::int64_t code;
  NumberType type;
};
constexpr NiftiType nifti_types[] = {
    {2, NumberType::uint8},     {4, NumberType::int16},    {8, NumberType::int32},
    {16, NumberType::float32},  {64, NumberType::float64}, {256, NumberType::int8},
    {512, NumberType::uint16},  {768, NumberType::uint32}, {1024, NumberType::int64},
    {1280, NumberType::uint64},
};

// Reads the heading of NIfTI-1. Bytes of its members are those of nifti1.h
class NiftiParser {
 public:
  explicit NiftiParser(const FileBytes& file) : file_(file), bytes_(file.bytes) {
    if (bytes_.starts_with("\x1f\x8b"))
      unpacked_ = inflated(bytes_, most_bytes, file.name), bytes_ = unpacked_;
  }

  LabelFile parse() {
    heading_.file.format = "NIfTI-1";
    check_kind();
    std::int64_t voxels_along = 1;
    for (std::size_t k = 0; k < 8; ++k) dimensions_[k] = integer(40 + 2 * k, NumberType::int16);
    for (std::size_t k = 4; k < 8 && static_cast<std::int64_t>(k) <= dimensions_[0]; ++k)
      voxels_along = std::max(voxels_along, dimensions_[k]);
    if (dimensions_[0] < 3 || dimensions_[0] > 7 || voxels_along > 1)
      fail(40, text("the image has ", dimensions_[0], " dimensions",
                    voxels_along > 1 ? " or several values for each voxel" : "",
                    "; expected 3 and a label for each voxel"));
    for (std::size_t k = 0; k < 3; ++k) heading_.size[k] = dimensions_[k + 1];
    const std::int64_t code = integer(70, NumberType::int16);
    const auto found = std::ranges::find(nifti_types, code, &NiftiType::code);
    if (found == std::end(nifti_types))
      fail(70, text("the data type is ", code, "; expected a whole or a real number"));
    heading_.type = found->type;
    read_scale();
    read_place();
    const double start = real(108);
    if (!(start >= 348 && start <= static_cast<double>(bytes_.size())))
      fail(108, text("the voxels start at byte ", number(start), " of ", bytes_.size()));
    const auto first = static_cast<std::size_t>(start);
    const std::size_t size = checked_voxels(heading_, file_.name) * bytes_of(heading_.type);
    heading_.order = order_;
    return with_labels(std::move(heading_), file_.name, bytes_.substr(first, size), place(first));
  }

 private:
  Place place(std::size_t byte) const {
    return unpacked_.empty() ? Place{0, static_cast<std::int64_t>(byte)} : Place{};
  }
  [[noreturn]] void fail(std::size_t byte, const std::string& why) const {
    refuse(file_.name, place(byte), why);
  }

  ByteNumbers numbers_at(std::size_t byte) const {
    return {file_.name, bytes_.substr(byte), order_, {0, static_cast<std::int64_t>(byte)}};
  }
  std::int64_t integer(std::size_t byte, NumberType type) const {
    return numbers_at(byte).integer(type, "a number of the heading");
  }
  double real(std::size_t byte) const {
    return numbers_at(byte).any_number(NumberType::float32, "a number of the heading");
  }

  // Checks the length of the heading, which tells the order of bytes, and the mark of the format
  void check_kind() {
    if (bytes_.size() < heading_bytes)
      refuse(
          file_.name, {},
          text("the file has ", bytes_.size(), " bytes; a heading of NIfTI has ", heading_bytes));
    constexpr auto other =
        std::endian::native == std::endian::little ? std::endian::big : std::endian::little;
    for (const std::endian order : {std::endian::native, other}) {
      order_ = order;
      const std::int64_t length = integer(0, NumberType::int32);
      if (length == 540) fail(0, "is NIfTI-2; expected NIfTI-1");
      if (length == 348) break;
      if (order == other)
        fail(0, "is no NIfTI image: its first number is no 348 in either order of bytes");
    }
    const std::string_view mark = bytes_.substr(344, 4);
    if (mark == std::string_view("ni1\0", 4))
      fail(344, "has its voxels in another file; expected one file, .nii");
    if (mark != std::string_view("n+1\0", 4))
      fail(344, "is no NIfTI image: the mark n+1 is missing, as in Analyze 7.5");
  }

  void read_scale() {
    const double slope = real(112), shift = real(116);
    if (slope != 0 && std::isfinite(slope) && std::isfinite(shift))
      heading_.slope = slope, heading_.shift = shift;
    const std::int64_t unit = integer(123, NumberType::uint8) & 7;
    heading_.file.unit = unit == 1 ? 1 : unit == 3 ? 1e-6 : 0.001;
    heading_.file.unit_is_said = unit >= 1 && unit <= 3;
  }

  // Takes the rows of the affine map, else the rotation as a quaternion, else the spacings alone
  void read_place() {
    LabelImage& image = heading_.file.image;
    const Point spacing(real(80), real(84), real(88));
    if (integer(254, NumberType::int16) > 0) {
      for (int row = 0; row < 3; ++row) {
        const auto at = 280 + 16 * static_cast<std::size_t>(row);
        for (int k = 0; k < 3; ++k) image.axes(row, k) = real(at + 4 * static_cast<std::size_t>(k));
        image.origin[row] = real(at + 12);
      }
      return;
    }
    image.axes = spacing.asDiagonal();
    if (integer(252, NumberType::int16) <= 0) return;
    const double b = real(256), c = real(260), d = real(264);
    const Eigen::Quaterniond turn(std::sqrt(std::max(0.0, 1 - b * b - c * c - d * d)), b, c, d);
    const double side = real(76) < 0 ? -1 : 1;
    image.axes = turn.normalized().toRotationMatrix() *
                 Point(spacing[0], spacing[1], side * spacing[2]).asDiagonal();
    image.origin = Point(real(268), real(272), real(276));
  }

  const FileBytes& file_;
  std::string unpacked_;
  std::string_view bytes_;
  std::endian order_ = std::endian::native;
  std::array<std::int64_t, 8> dimensions_ = {};
  ImageHeading heading_;
};

}  // namespace

LabelFile parse_nifti(const FileBytes& file) { return NiftiParser(file).parse(); }

}  // namespace plica
