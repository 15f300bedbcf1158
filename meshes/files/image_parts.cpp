// SPDX-License-Identifier: BSD-3-Clause
#include <zlib.h>

#include <Eigen/LU>  // determinant()
#include <algorithm>
#include <cmath>
#include <limits>
#include <plica/core/text.hpp>
#include <plica/meshes/files/image_parts.hpp>
#include <set>

namespace plica {

namespace {

constexpr std::size_t most_labels = 1000;

struct Inflation {
  z_stream stream = {};
  bool ready = inflateInit2(&stream, 15 + 32) == Z_OK;  // both formats, told by their first bytes
  Inflation() = default;
  Inflation(const Inflation&) = delete;
  Inflation& operator=(const Inflation&) = delete;
  ~Inflation() { inflateEnd(&stream); }
};

int label_of(double value, std::size_t voxel, const ImageHeading& heading, const Numbers& numbers) {
  if (value >= 0 && value <= std::numeric_limits<int>::max() && value == std::floor(value))
    return static_cast<int>(value);
  const auto index = static_cast<std::int64_t>(voxel);
  const std::int64_t rows = heading.size[0] * heading.size[1];
  numbers.fail(text("voxel [", index % heading.size[0], ", ", index % rows / heading.size[0], ", ",
                    index / rows, "] has the value ", number(value),
                    "; expected a label, a whole number from 0"));
}

}  // namespace

std::size_t checked_voxels(const ImageHeading& heading, const std::string& file) {
  double all = 1;
  for (const std::int64_t size : heading.size) {
    if (size < 1) refuse(file, {}, text("the image has ", size, " voxels along an axis"));
    all *= static_cast<double>(size);
  }
  if (all > std::numeric_limits<int>::max())
    refuse(file, {}, text("the image has ", number(all, 4), " voxels; 2147483647 at most"));
  const LabelImage& image = heading.file.image;
  if (!image.origin.allFinite() || !image.axes.allFinite())
    refuse(file, {}, "the image's origin and axes must be finite");
  const double lengths = image.axes.colwise().norm().prod();
  if (!(std::abs(image.axes.determinant()) > 1e-6 * lengths))
    refuse(file, {}, "the image's axes lie in one plane, or a spacing is 0");
  return static_cast<std::size_t>(all);
}

LabelFile with_labels(ImageHeading heading, Numbers& numbers) {
  const std::size_t voxels = checked_voxels(heading, numbers.file());
  if (numbers.room(heading.type) < static_cast<std::int64_t>(voxels))
    numbers.fail(text("the image has ", voxels, " voxels, but the rest of the file has room for ",
                      numbers.room(heading.type)));
  LabelImage& image = heading.file.image;
  for (std::size_t k = 0; k < 3; ++k) image.size[k] = static_cast<int>(heading.size[k]);
  image.labels.reserve(voxels);
  std::set<int> used;
  for (std::size_t v = 0; v < voxels; ++v) {
    const double value = is_integer(heading.type)
                             ? static_cast<double>(numbers.integer(heading.type, "a voxel"))
                             : numbers.any_number(heading.type, "a voxel");
    const int label = label_of(heading.slope * value + heading.shift, v, heading, numbers);
    if (image.labels.empty() || label != image.labels.back()) used.insert(label);
    image.labels.push_back(label);
    if (used.size() > most_labels)
      numbers.fail(text("the voxels have more than ", most_labels,
                        " different values; expected the labels of a segmentation, no scan"));
  }
  return std::move(heading.file);
}

LabelFile with_labels(ImageHeading heading, const std::string& file, std::string_view bytes,
                      Place first) {
  const std::size_t expected = checked_voxels(heading, file) * bytes_of(heading.type);
  if (bytes.size() != expected)
    refuse(file, first,
           text("the voxels are ", bytes.size(), " bytes; expected ", expected, ", ",
                bytes_of(heading.type), " for each of ", heading.size[0], " x ", heading.size[1],
                " x ", heading.size[2]));
  ByteNumbers numbers(file, bytes, heading.order, first);
  return with_labels(std::move(heading), numbers);
}

std::string inflated(std::string_view bytes, std::size_t most, const std::string& file) {
  constexpr std::size_t most_at_once = 1 << 30;
  Inflation inflation;
  z_stream& stream = inflation.stream;
  std::string all;
  std::vector<char> part(1 << 18);
  int result = inflation.ready ? Z_OK : Z_MEM_ERROR;
  while (result == Z_OK) {
    if (stream.avail_in == 0) {
      const std::size_t taken = std::min(bytes.size(), most_at_once);
      stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
      stream.avail_in = static_cast<uInt>(taken);
      bytes.remove_prefix(taken);
    }
    stream.next_out = reinterpret_cast<Bytef*>(part.data());
    stream.avail_out = static_cast<uInt>(part.size());
    result = inflate(&stream, Z_NO_FLUSH);
    all.append(part.data(), part.size() - stream.avail_out);
    if (all.size() > most)
      refuse(file, {},
             text("the compressed data hold more than ", most,
                  " bytes, which is too "
                  "many"));
    const bool more = stream.avail_in > 0 || !bytes.empty();
    if (result == Z_STREAM_END && more) result = inflateReset(&stream);  // the next part of gzip's
  }
  if (result != Z_STREAM_END) refuse(file, {}, "the compressed data are broken or cut short");
  return all;
}

std::vector<std::string_view> list_words(std::string_view text) {
  constexpr std::string_view between = " \t\r\n,()\"";
  std::vector<std::string_view> words;
  while (true) {
    const std::size_t begin = text.find_first_not_of(between);
    if (begin == std::string_view::npos) return words;
    const std::size_t end = std::min(text.find_first_of(between, begin), text.size());
    words.push_back(text.substr(begin, end - begin));
    text.remove_prefix(end);
  }
}

std::vector<double> list_numbers(std::string_view text, std::size_t count, const std::string& field,
                                 const std::string& file, const Place& place) {
  std::vector<double> numbers;
  for (const std::string_view word : list_words(text)) {
    const auto one = number_in(word);
    if (!one || !std::isfinite(*one)) break;
    numbers.push_back(*one);
  }
  if (numbers.size() != count || list_words(text).size() != count)
    refuse(file, place,
           field + " is " + shown(text) + "; expected " + std::to_string(count) + " numbers");
  return numbers;
}

double metres_per(std::string_view unit) {
  if (unit == "m") return 1;
  if (unit == "cm") return 0.01;
  if (unit == "mm") return 0.001;
  return unit == "um" || unit == "microns" ? 1e-6 : 0;
}

}  // namespace plica
