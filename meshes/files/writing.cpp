// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <plica/meshes/files/writing.hpp>
#include <set>

namespace plica {

namespace {

// The number after the last underscore, from 1; 0: there is none
std::int64_t number_at_end(const std::string& name) {
  const std::size_t at = name.rfind('_');
  std::int64_t number = 0;
  if (at == std::string::npos) return 0;
  const char *begin = name.data() + at + 1, *end = name.data() + name.size();
  const auto [stop, error] = std::from_chars(begin, end, number);
  return error == std::errc() && stop == end && *begin != '0' && number > 0 && number < 1'000'000'000 ? number : 0;
}

template <typename Number>
void append(std::string& text, Number number) {
  char digits[32];
  text.append(digits, std::to_chars(digits, digits + sizeof(digits), number).ptr);
}

}  // namespace

TextOut& TextOut::operator<<(double number) { return append(text_, number), *this; }

TextOut& TextOut::operator<<(std::int64_t number) { return append(text_, number), *this; }

std::vector<std::int64_t> numbers_of(const std::vector<std::string>& names) {
  std::vector<std::int64_t> numbers;
  for (const std::string& name : names) numbers.push_back(number_at_end(name));
  const std::set<std::int64_t> used(numbers.begin(), numbers.end());
  if (used.size() == numbers.size() && !used.contains(0)) return numbers;
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<std::int64_t>(i) + 1;
  return numbers;
}

std::vector<std::int64_t> region_numbers(const TetMesh& mesh) {
  const std::vector<std::int64_t> numbers = numbers_of(mesh.region_names);
  std::vector<std::int64_t> regions;
  for (const int region : mesh.region) regions.push_back(numbers[static_cast<std::size_t>(region)]);
  return regions;
}

void leave_out_region_names(const TetMesh& mesh, const std::string& prefix, WrittenMesh& written) {
  const std::vector<std::int64_t> numbers = numbers_of(mesh.region_names);
  for (std::size_t i = 0; i < numbers.size(); ++i)
    if (const std::string now = prefix + std::to_string(numbers[i]); mesh.region_names[i] != now)
      written.left_out.push_back("the region '" + mesh.region_names[i] + "' is now '" + now +
                                 "', as this format numbers them");
}

void leave_out_vertex_sets(const TetMesh& mesh, WrittenMesh& written) {
  for (const auto& [name, vertices] : mesh.vertex_sets)
    written.left_out.push_back("the vertex set '" + name + "' is left out: this format has none");
}

NumbersOut& NumbersOut::text(std::string_view text) { return bytes_ += text, *this; }

template <typename Number>
NumbersOut& NumbersOut::add(Number number) {
  if (binary_) {
    std::array<char, sizeof(Number)> bytes;
    std::memcpy(bytes.data(), &number, sizeof(Number));
    if (order_ != std::endian::native) std::reverse(bytes.begin(), bytes.end());
    bytes_.append(bytes.data(), bytes.size());
    return *this;
  }
  char digits[32];
  if (line_begun_) bytes_ += ' ';
  bytes_.append(digits, std::to_chars(digits, digits + sizeof(digits), number).ptr);
  line_begun_ = true;
  return *this;
}

NumbersOut& NumbersOut::int32(std::int64_t number) { return add(static_cast<std::int32_t>(number)); }
NumbersOut& NumbersOut::int64(std::int64_t number) { return add(number); }
NumbersOut& NumbersOut::real32(double number) { return binary_ ? add(static_cast<float>(number)) : add(number); }
NumbersOut& NumbersOut::real64(double number) { return add(number); }

NumbersOut& NumbersOut::end() {
  if (!binary_) bytes_ += '\n';
  line_begun_ = false;
  return *this;
}

}  // namespace plica
