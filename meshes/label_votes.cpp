// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/LU>  // inverse()
#include <algorithm>
#include <cmath>
#include <plica/meshes/label_votes.hpp>

namespace plica {

namespace {

constexpr int points_along = 3;  // points of a ball along an axis, on each side of its centre

int count_of(const std::vector<std::pair<int, int>>& votes, int label) {
  for (const auto& [one, count] : votes)
    if (one == label) return count;
  return 0;
}

}  // namespace

LabelVotes::LabelVotes(const LabelImage& image, double radius)
    : image_(image), radius_(radius), to_voxels_(image.axes.inverse()) {
  const double step = radius / (points_along + 0.5);
  for (int k = -points_along; k <= points_along; ++k)
    for (int j = -points_along; j <= points_along; ++j)
      for (int i = -points_along; i <= points_along; ++i)
        if (const Point offset = step * Point(i, j, k); offset.norm() <= radius)
          offsets_.push_back(offset);
}

int LabelVotes::at(const Point& x) const {
  const Point place = to_voxels_ * (x - image_.origin);
  std::size_t index = 0;
  for (std::size_t k = 3; k-- > 0;) {
    const double voxel = std::floor(place[static_cast<int>(k)] + 0.5);
    if (!(voxel >= 0 && voxel < image_.size[k])) return 0;
    index = index * static_cast<std::size_t>(image_.size[k]) + static_cast<std::size_t>(voxel);
  }
  return image_.labels[index];
}

// Returns the labels in the ball at a point, each with its number of points
std::vector<std::pair<int, int>> LabelVotes::votes(const Point& x) const {
  std::vector<std::pair<int, int>> votes;
  for (const Point& offset : offsets_) {
    const int label = at(x + offset);
    const auto found =
        std::ranges::find_if(votes, [label](const auto& one) { return one.first == label; });
    if (found == votes.end())
      votes.emplace_back(label, 1);
    else
      ++found->second;
  }
  return votes;
}

int LabelVotes::most(const Point& x) const {
  std::pair<int, int> best = {0, 0};
  for (const auto& [label, count] : votes(x))
    if (count > best.second || (count == best.second && label < best.first)) best = {label, count};
  return best.first;
}

double LabelVotes::margin(const Point& x, int a, int b) const {
  const auto all = votes(x);
  return static_cast<double>(count_of(all, a) - count_of(all, b)) /
         static_cast<double>(offsets_.size());
}

std::optional<BesideInterface> LabelVotes::beside(const Point& x,
                                                  const std::vector<int>& labels) const {
  const auto all = votes(x);
  std::vector<std::pair<int, int>> own;  // count and label
  for (const int label : labels)
    if (const int count = count_of(all, label); count > 0) own.emplace_back(count, label);
  if (own.size() < 2) return {};
  std::ranges::sort(own, [](const auto& a, const auto& b) { return a.first > b.first; });
  const auto [more, inside] = own[0];
  const auto [less, other] = own[1];
  Point to_inside = Point::Zero();
  for (const Point& offset : offsets_)
    if (const int label = at(x + offset); label == inside)
      to_inside += offset;
    else if (label == other)
      to_inside -= offset;
  if (!(to_inside.norm() > 0)) return {};
  const double part = static_cast<double>(more) / (more + less);
  return BesideInterface{inside, other, 2 * std::sin(std::asin(2 * part - 1) / 3) * radius_,
                         to_inside.normalized()};
}

}  // namespace plica
