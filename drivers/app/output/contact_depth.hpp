// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <limits>
#include <plica/core/problem.hpp>
#include <plica/core/text.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <string>
#include <vector>

namespace plica::app {

/// How deep something was at the most.
struct Penetration {
  double depth = 0, time = 0;  ///< [m]; when [s]
};

/// The greatest depths of a run, of what it looked at.
struct Penetrations {
  double edge = 0;                          ///< mean one of the surface [m]
  std::vector<std::string> obstacles = {};  ///< their names
  /// in each of them, then, where bodies touch, in a body
  std::vector<Penetration> deepest = {};
  bool pairs = false;  ///< they do
};

/// Of a surface's triangles [m].
inline double mean_edge_of(const TriangleSurface& surface) {
  double sum = 0;
  for (const auto& t : surface.triangles)
    for (std::size_t k = 0; k < 3; ++k)
      sum += (surface.vertices[static_cast<std::size_t>(t[(k + 1) % 3])] -
              surface.vertices[static_cast<std::size_t>(t[k])])
                 .norm();
  return surface.triangles.empty() ? 0 : sum / (3 * static_cast<double>(surface.triangles.size()));
}

/// Looks whether obstacles come visibly deep into the surface, or through it: contact is by
/// penalties, and too soft a one lets a tool sink in.
class ContactDepth {
 public:
  static constexpr double visible = 0.5;  ///< of a mean edge, or of the radius of a thinner tool

  /// @param edge  mean one of the finest level [m]
  /// @param pairs bodies touch, or a body itself
  ContactDepth(const ContactOptions& contact, double edge, const TriangleSurface& surface,
               bool pairs)
      : edge_(edge) {
    for (std::size_t o = 0; o < contact.obstacles.size(); ++o) {
      all_.obstacles.push_back(obstacle_name(contact, o));
      radius_.push_back(radius_of(contact.obstacles[o].shape));
    }
    all_.pairs = pairs, all_.edge = mean_edge_of(surface);
    all_.deepest.resize(all_.obstacles.size() + (pairs ? 1 : 0));
  }

  bool looks() const { return !all_.deepest.empty(); }

  /// At this time [s]; depths of all obstacles [m], what obstacles_inside() says, and the depth in
  /// bodies.
  void look(double time, const std::vector<double>& depths, const std::vector<int>& inside,
            double of_pairs = 0) {
    if (inside_ < 0 && !inside.empty()) inside_ = inside.front(), inside_at_ = time;
    for (std::size_t o = 0; o < depths.size(); ++o) {
      if (depth_ * limit(o) < depths[o] * limit(static_cast<std::size_t>(obstacle_)))
        depth_ = depths[o], at_ = time, obstacle_ = static_cast<double>(o);
      deepen(o, depths[o], time);
    }
    if (all_.pairs) deepen(all_.obstacles.size(), of_pairs, time);
  }
  const Penetrations& all() const { return all_; }

  /// What there is to go on from, and going on from it.
  std::vector<double> save() const {
    std::vector<double> saved = {depth_, at_, obstacle_, inside_, inside_at_};
    for (const Penetration& p : all_.deepest) saved.insert(saved.end(), {p.depth, p.time});
    return saved;
  }
  void restore(const std::vector<double>& saved) {
    if (saved.size() < 5 + 2 * all_.deepest.size()) return;
    depth_ = saved[0], at_ = saved[1], obstacle_ = saved[2], inside_ = saved[3],
    inside_at_ = saved[4];
    for (std::size_t i = 0; i < all_.deepest.size(); ++i)
      all_.deepest[i] = {saved[5 + 2 * i], saved[6 + 2 * i]};
  }

  /// A sentence where one was, else nothing.
  std::string warning() const {
    if (inside_ >= 0)
      return text("contact: at ", number(inside_at_, 4), " s ",
                  all_.obstacles.at(static_cast<std::size_t>(inside_)),
                  " was inside the body and touched nothing: it has come through the surface, and "
                  "the body does not feel "
                  "it there; expected a slower obstacle, a smaller integration.macro_step, or "
                  "contact.stiffness_scale "
                  "above 1");
    const auto which = static_cast<std::size_t>(obstacle_);
    if (all_.obstacles.empty() || !(depth_ > limit(which))) return {};
    const bool thin = radius_[which] < edge_;
    return text("contact: at ", number(at_, 4), " s ", all_.obstacles[which], " was ",
                number(depth_, 3), " m deep in the surface, ",
                number(depth_ / (thin ? radius_[which] : edge_), 3), " of ",
                thin ? "its radius, and may come through" : "a mean edge",
                ": its force is less than that of a hard one; expected contact.stiffness_scale "
                "above 1, which on "
                "implicit levels needs a smaller integration.macro_step, or a slower obstacle");
  }

 private:
  static double radius_of(const ShapeOptions& shape) {
    double radius = std::numeric_limits<double>::infinity();
    visit_shape(shape, [&](auto kind, const auto& options) {
      if constexpr (requires { kind.radius(options); }) radius = kind.radius(options);
    });
    return radius;
  }
  /// What is deeper is told of [m].
  double limit(std::size_t obstacle) const { return visible * std::min(edge_, radius_[obstacle]); }
  void deepen(std::size_t i, double depth, double time) {
    if (depth > all_.deepest[i].depth) all_.deepest[i] = {depth, time};
  }

  Penetrations all_;
  std::vector<double> radius_;  // of the obstacles [m]
  double edge_, depth_ = 0, at_ = 0, obstacle_ = 0, inside_ = -1, inside_at_ = 0;
};

}  // namespace plica::app
