// SPDX-License-Identifier: BSD-3-Clause
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <plica/meshes/files/label_files.hpp>

#include "mesh_input.hpp"

// Images of labels: the same image of 2 x 3 x 4 voxels in every format, type and order of bytes.
namespace {

using namespace plica;
using namespace plica::test;

constexpr std::array<int, 3> voxels = {2, 3, 4};

// Labels of the image: 0, 1, 2, 100, and again
std::vector<int> expected_labels() {
  std::vector<int> labels;
  for (int v = 0; v < 24; ++v) labels.push_back(v % 4 == 3 ? 100 : v % 4);
  return labels;
}

template <class Number>
std::string bytes_of_numbers(const std::vector<Number>& numbers, bool big) {
  std::string bytes;
  for (const Number number : numbers) {
    char one[sizeof(Number)];
    std::memcpy(one, &number, sizeof(Number));
    if (big != (std::endian::native == std::endian::big)) std::reverse(one, one + sizeof(Number));
    bytes.append(one, sizeof(Number));
  }
  return bytes;
}

template <class Number>
std::string voxel_bytes(bool big = false) {
  std::vector<Number> numbers;
  for (const int label : expected_labels()) numbers.push_back(static_cast<Number>(label));
  return bytes_of_numbers(numbers, big);
}

// Compresses in gzip's format (31) or zlib's (15)
std::string deflated(std::string bytes, int format) {
  z_stream stream = {};
  EXPECT_EQ(deflateInit2(&stream, 9, Z_DEFLATED, format, 8, Z_DEFAULT_STRATEGY), Z_OK);
  std::string out(bytes.size() + 1000, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(bytes.data());
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  return out;
}

std::string nrrd(const std::string& type, const std::string& encoding,
                 const std::string& more = "") {
  return "NRRD0005\n# made for a test\ntype: " + type +
         "\ndimension: 3\nspace: left-posterior-superior\nsizes: 2 3 4\nspace directions: "
         "(0.5,0,0) "
         "(0,0,2) (0,-1,0)\nspace origin: (10,20,30)\nencoding: " +
         encoding + "\n" + more + "\n";
}

std::string vtk_image(const std::string& form, const std::string& type, const std::string& values) {
  return "# vtk DataFile Version 3.0\nimage\n" + form +
         "\nDATASET STRUCTURED_POINTS\nDIMENSIONS 2 3 4\nSPACING 0.5 1 2\nORIGIN 10 20 30\n"
         "POINT_DATA 24\nSCALARS labels " +
         type + " 1\nLOOKUP_TABLE default\n" + values;
}

std::string mha(const std::string& type, const std::string& more = "") {
  return "ObjectType = Image\nNDims = 3\nBinaryData = True\n" + more +
         "TransformMatrix = 1 0 0 0 0 1 0 -1 0\nOffset = 10 20 30\nElementSpacing = 0.5 2 "
         "1\nDimSize = 2 3 4\nElementType = " +
         type + "\nElementDataFile = LOCAL\n";
}

// A heading of NIfTI-1 with an affine map, for 16 bits
std::string nifti_heading(bool big, std::int16_t code = 4) {
  std::string heading(352, '\0');
  const auto put = [&](std::size_t at, const std::string& bytes) {
    heading.replace(at, bytes.size(), bytes);
  };
  put(0, bytes_of_numbers<std::int32_t>({348}, big));
  put(40, bytes_of_numbers<std::int16_t>({3, 2, 3, 4, 1, 1, 1, 1}, big));
  put(70, bytes_of_numbers<std::int16_t>({code, 16}, big));
  put(76, bytes_of_numbers<float>({1, 0.5F, 2, 1, 0, 0, 0, 0, 352, 0, 0}, big));
  heading[123] = 2;  // millimetres
  put(252, bytes_of_numbers<std::int16_t>({0, 1}, big));
  put(280, bytes_of_numbers<float>({0.5F, 0, 0, 10, 0, 0, -1, 20, 0, 2, 0, 30}, big));
  put(344, std::string("n+1\0", 4));
  return heading;
}

void expect_labels(const LabelFile& read, const std::string& format) {
  EXPECT_EQ(read.image.size, voxels);
  EXPECT_EQ(read.image.labels, expected_labels());
  EXPECT_EQ(read.image.origin, Point(10, 20, 30));
  EXPECT_EQ(read.format, format);
}

// Ways to the next voxel: half along x, two along z, one against y
void expect_turned(const LabelFile& read, const std::string& format) {
  expect_labels(read, format);
  Eigen::Matrix3d axes;
  axes << 0.5, 0, 0, 0, 0, -1, 0, 2, 0;
  EXPECT_EQ(read.image.axes, axes) << read.image.axes;
}

LabelFile labels_in(const std::string& name, const std::string& bytes) {
  const FileBytes file{name, bytes};
  EXPECT_TRUE(is_image(file));
  return read_labels(file);
}

void expect_no_labels(const std::string& name, const std::string& bytes, const std::string& place,
                      const std::vector<std::string>& parts) {
  expect_refused([&] { read_labels({name, bytes}); }, place, parts);
}

TEST(LabelFiles, Nrrd) {
  expect_turned(labels_in("a.nrrd", nrrd("uchar", "raw") + voxel_bytes<std::uint8_t>()), "NRRD");
  const std::string big = nrrd("int16", "raw", "endian: big\n") + voxel_bytes<std::int16_t>(true);
  expect_turned(labels_in("a.nrrd", big), "NRRD");
  const std::string real = nrrd("float", "raw", "endian: little\n") + voxel_bytes<float>();
  expect_turned(labels_in("a.nrrd", real), "NRRD");
  expect_turned(labels_in("a.nrrd", nrrd("unsigned int", "gzip", "endian: little\n") +
                                        deflated(voxel_bytes<std::uint32_t>(), 31)),
                "NRRD");
  std::string text;
  for (const int label : expected_labels())
    text += std::to_string(label) + (label == 2 ? "\n" : " ");
  expect_turned(labels_in("a.nrrd", nrrd("short", "ascii") + text), "NRRD");
  const LabelFile named = labels_in(
      "a.seg.nrrd",
      nrrd("uchar", "raw",
           "space units: \"cm\" \"cm\" \"cm\"\nSegment0_LabelValue:=100\nSegment0_Name:=liver\n") +
          voxel_bytes<std::uint8_t>());
  EXPECT_EQ(named.image.names, (std::map<int, std::string>{{100, "liver"}}));
  EXPECT_TRUE(named.unit_is_said);
  EXPECT_EQ(named.unit, 0.01);
}

TEST(LabelFiles, Nifti) {
  for (const bool big : {false, true}) {
    const std::string file = nifti_heading(big) + voxel_bytes<std::int16_t>(big);
    const LabelFile read = labels_in("a.nii", file);
    expect_turned(read, "NIfTI-1");
    EXPECT_TRUE(read.unit_is_said);
    EXPECT_EQ(read.unit, 0.001);
    expect_turned(labels_in("a.nii.gz", deflated(file, 31)), "NIfTI-1");
  }
  // A quarter turn about x as a quaternion: y goes to z, and z to minus y
  std::string turned = nifti_heading(false) + voxel_bytes<std::int16_t>();
  turned.replace(252, 4, bytes_of_numbers<std::int16_t>({1, 0}, false));
  turned.replace(256, 24, bytes_of_numbers<float>({std::sqrt(0.5F), 0, 0, 10, 20, 30}, false));
  const LabelFile read = labels_in("a.nii", turned);
  expect_labels(read, "NIfTI-1");
  Eigen::Matrix3d axes;
  axes << 0.5, 0, 0, 0, 0, -1, 0, 2, 0;
  EXPECT_LE((read.image.axes - axes).norm(), 1e-6) << read.image.axes;
  // slope and shift
  std::string scaled = nifti_heading(false) + voxel_bytes<std::int16_t>();
  scaled.replace(112, 8, bytes_of_numbers<float>({2, 1}, false));
  EXPECT_EQ(labels_in("a.nii", scaled).image.labels[3], 201);
}

TEST(LabelFiles, MetaImage) {
  expect_turned(labels_in("a.mha", mha("MET_UCHAR") + voxel_bytes<std::uint8_t>()), "MetaImage");
  expect_turned(labels_in("a.mha", mha("MET_SHORT", "BinaryDataByteOrderMSB = True\n") +
                                       voxel_bytes<std::int16_t>(true)),
                "MetaImage");
  expect_turned(labels_in("a.mha", mha("MET_DOUBLE", "CompressedData = True\n") +
                                       deflated(voxel_bytes<double>(), 15)),
                "MetaImage");
}

TEST(LabelFiles, StructuredPointsOfVtk) {
  const auto expect_straight = [](const LabelFile& read) {
    expect_labels(read, "VTK legacy, structured points");
    EXPECT_EQ(read.image.axes, Eigen::Matrix3d(Point(0.5, 1, 2).asDiagonal()));
  };
  std::string text;
  for (const int label : expected_labels()) text += std::to_string(label) + "\n";
  expect_straight(labels_in("a.vtk", vtk_image("ASCII", "int", text)));
  expect_straight(labels_in(
      "a.vtk", vtk_image("BINARY", "unsigned_short", voxel_bytes<std::uint16_t>(true) + "\n")));
  // Values of cells, which have their points at the corners
  const std::string cells = with(
      with(with(vtk_image("ASCII", "float", text), "2 3 4", "3 4 5"), "POINT_DATA", "CELL_DATA"),
      "ORIGIN 10 20 30", "ORIGIN 9.75 19.5 29");
  expect_straight(labels_in("a.vtk", cells));
}

TEST(LabelFiles, BadOnesAreRefused) {
  const std::string raw = nrrd("uchar", "raw") + voxel_bytes<std::uint8_t>();
  expect_no_labels("a.nrrd", raw.substr(0, raw.size() - 1), "a.nrrd: byte 181",
                   {"the voxels are 23 bytes; expected 24, 1 for each of 2 x 3 x 4"});
  expect_no_labels("a.nrrd", raw + "x", "a.nrrd: byte 181", {"25 bytes; expected 24"});
  expect_no_labels("a.nrrd", with(raw, "uchar", "ucher"), "a.nrrd:3", {"type is 'ucher'"});
  expect_no_labels("a.nrrd", with(raw, "uchar", "short"), "a.nrrd",
                   {"the field endian is missing"});
  expect_no_labels("a.nrrd", with(raw, "sizes: 2 3 4", "sizes: 2 3 0"), "a.nrrd:6", {"sizes"});
  expect_no_labels("a.nrrd", with(raw, "sizes: 2 3 4", "sizes: 99999 99999 999"), "a.nrrd",
                   {"voxels; 2147483647 at most"});
  expect_no_labels("a.nrrd", with(raw, "dimension: 3", "dimension: 4"), "a.nrrd:4",
                   {"dimension is '4'; expected 3"});
  expect_no_labels("a.nrrd", with(raw, "(0,0,2)", "none"), "a.nrrd:7", {"expected 9 numbers"});
  expect_no_labels("a.nrrd", with(raw, "(0,0,2)", "(1,0,0)"), "a.nrrd", {"lie in one plane"});
  expect_no_labels("a.nrrd", with(raw, "encoding: raw", "encoding: bzip2"), "a.nrrd:9",
                   {"encoding is 'bzip2'"});
  expect_no_labels("a.nrrd",
                   nrrd("uchar", "gzip") + deflated(voxel_bytes<std::uint8_t>(), 31).substr(0, 20),
                   "a.nrrd", {"broken or cut short"});
  expect_no_labels("a.nrrd", nrrd("uchar", "gzip") + deflated(std::string(1000, 'a'), 31), "a.nrrd",
                   {"hold more than 24 bytes"});
  const std::string real = nrrd("float", "raw", "endian: little\n");
  std::vector<float> values(24, 1);
  values[7] = 0.5F;
  expect_no_labels("a.nrrd", real + bytes_of_numbers(values, false), "a.nrrd: byte 224",
                   {"voxel [1, 0, 1] has the value 0.5; expected a label"});
  values[7] = -1;
  expect_no_labels("a.nrrd", real + bytes_of_numbers(values, false), "a.nrrd: byte 224", {"-1"});

  const std::string nii = nifti_heading(false) + voxel_bytes<std::int16_t>();
  expect_no_labels("a.nii", nii.substr(0, 300), "a.nii", {"300 bytes"});
  expect_no_labels("a.nii", nii.substr(0, nii.size() - 2), "a.nii: byte 352",
                   {"46 bytes; expected 48"});
  expect_no_labels("a.nii", nifti_heading(false, 128) + "x", "a.nii: byte 70",
                   {"data type is 128"});
  expect_no_labels("a.nii", with(nii, "n+1", "ni1"), "a.nii: byte 344", {"in another file"});
  std::string four = nii;
  four.replace(40, 10, bytes_of_numbers<std::int16_t>({4, 2, 3, 4, 5}, false));
  expect_no_labels("a.nii", four, "a.nii: byte 40", {"several values for each voxel"});
  expect_no_labels("a.nii.gz", deflated(nii, 31).substr(0, 30), "a.nii.gz", {"cut short"});

  const std::string meta = mha("MET_UCHAR") + voxel_bytes<std::uint8_t>();
  expect_no_labels("a.mha", with(meta, "LOCAL", "a.raw"), "a.mha:9", {"expected LOCAL"});
  expect_no_labels("a.mha", with(meta, "MET_UCHAR", "MET_RGB"), "a.mha:8", {"MET_UCHAR"});
  expect_no_labels("a.mha", with(meta, "2 3 4", "2 3"), "a.mha:7", {"expected 3 numbers"});
  expect_no_labels("a.vtk", vtk_image("ASCII", "int", "1 2 3\n"), "a.vtk:10", {"24 voxels"});
  expect_no_labels("a.vtk", with(vtk_image("ASCII", "int", ""), "2 3 4", "2 3 5"), "a.vtk:10",
                   {"24 values for 30 voxels"});
  expect_no_labels("a.vtk", with(vtk_image("ASCII", "int", ""), " int ", " bit "), "a.vtk:9",
                   {"the type of the array is 'bit'"});
  expect_no_labels("a.txt", "labels", "a.txt", {"is no image of labels"});
  std::vector<std::int16_t> scan;
  for (int v = 0; v < 1100; ++v) scan.push_back(static_cast<std::int16_t>(v));
  expect_no_labels("a.nrrd",
                   with(nrrd("short", "raw", "endian: little\n"), "2 3 4", "11 10 10") +
                       bytes_of_numbers(scan, false),
                   "a.nrrd: byte 2199", {"more than 1000 different values"});
}

TEST(LabelFiles, AnyByteMayBeWrong) {
  for (const std::string& bytes :
       {nrrd("float", "raw", "endian: little\n") + voxel_bytes<float>(),
        nifti_heading(false) + voxel_bytes<std::int16_t>(),
        mha("MET_UCHAR") + voxel_bytes<std::uint8_t>(),
        vtk_image("BINARY", "unsigned_short", voxel_bytes<std::uint16_t>(true))})
    change_every_byte(
        {"a", bytes}, [](const FileBytes& file) { return read_labels(file); },
        [](const LabelFile& read) {
          EXPECT_EQ(read.image.labels.size(), static_cast<std::size_t>(read.image.size[0]) *
                                                  static_cast<std::size_t>(read.image.size[1]) *
                                                  static_cast<std::size_t>(read.image.size[2]));
        });
}

}  // namespace
