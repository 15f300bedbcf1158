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

/// Largest depth during a run.
struct Penetration {
  double depth = 0, time = 0;  ///< depth [m] and the time when it was reached [s]
};

/// Largest depths of the surface in obstacles and bodies, in all frames of a run.
struct Penetrations {
  double edge = 0;                          ///< mean edge length of the surface [m]
  std::vector<std::string> obstacles = {};  ///< names of the obstacles
  /// largest depth in each obstacle; then, if `pairs`, the largest depth in a body
  std::vector<Penetration> deepest = {};
  bool pairs = false;  ///< true: bodies can touch each other or themselves
};

/// Returns the mean edge length of a surface's triangles [m]; 0: no triangles.
inline double mean_edge_of(const TriangleSurface& surface) {
  double sum = 0;
  for (const auto& t : surface.triangles)
    for (std::size_t k = 0; k < 3; ++k)
      sum += (surface.vertices[static_cast<std::size_t>(t[(k + 1) % 3])] -
              surface.vertices[static_cast<std::size_t>(t[k])])
                 .norm();
  return surface.triangles.empty() ? 0 : sum / (3 * static_cast<double>(surface.triangles.size()));
}

/// Detects obstacles that come visibly deep into the surface, or through it. Contact forces are
/// penalties; if the penalty is too soft, a tool sinks into the body.
class ContactDepth {
 public:
  static constexpr double visible = 0.5;  ///< limit, in mean edges, or in radii of a thinner tool
  /// Limit between bodies, in mean edges: half of the distance within which a partner is found
  static constexpr double visible_in_bodies = 0.25;

  /// @param edge    mean edge length of the finest level [m]
  /// @param surface the embedded surface; its mean edge is reported beside the depths
  /// @param pairs   true: bodies can touch each other or themselves
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

  /// Returns true if there is an obstacle or a pair to look at.
  bool looks() const { return !all_.deepest.empty(); }

  /// Takes in the depths at this time [s].
  /// @param depths   depth of the surface in each obstacle [m]
  /// @param inside   result of obstacles_inside()
  /// @param of_pairs depth of the surface in bodies [m]
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

  /// Returns the values that restore() needs in a resumed run.
  std::vector<double> save() const {
    std::vector<double> saved = {depth_, at_, obstacle_, inside_, inside_at_};
    for (const Penetration& p : all_.deepest) saved.insert(saved.end(), {p.depth, p.time});
    return saved;
  }
  /// Restores the values that save() has returned. Throws InputError for another number of them.
  void restore(const std::vector<double>& saved) {
    expect_saved("contact depths", saved.size(), 5 + 2 * all_.deepest.size());
    depth_ = saved[0], at_ = saved[1], obstacle_ = saved[2], inside_ = saved[3],
    inside_at_ = saved[4];
    for (std::size_t i = 0; i < all_.deepest.size(); ++i)
      all_.deepest[i] = {saved[5 + 2 * i], saved[6 + 2 * i]};
  }

  /// Returns a warning if an obstacle came too deep or through the surface; empty: none did.
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
    if (all_.obstacles.empty() || !(depth_ > limit(which))) return warning_of_bodies();
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
  /// Returns a warning if bodies came too deep into each other or themselves; empty: none did.
  std::string warning_of_bodies() const {
    if (!all_.pairs || !(all_.deepest.back().depth > visible_in_bodies * edge_)) return {};
    return text("contact: at ", number(all_.deepest.back().time, 4), " s a body was ",
                number(all_.deepest.back().depth, 3), " m deep in a body, ",
                number(all_.deepest.back().depth / edge_, 3),
                " of a mean edge, and may come through: a partner is found within half an edge; "
                "expected contact.stiffness_scale above 1, a smaller integration.macro_step, or "
                "slower bodies");
  }
  static double radius_of(const ShapeOptions& shape) {
    double radius = std::numeric_limits<double>::infinity();
    visit_shape(shape, [&](auto kind, const auto& options) {
      if constexpr (requires { kind.radius(options); }) radius = kind.radius(options);
    });
    return radius;
  }
  /// Returns the depth in an obstacle above which a warning is given [m].
  double limit(std::size_t obstacle) const { return visible * std::min(edge_, radius_[obstacle]); }
  void deepen(std::size_t i, double depth, double time) {
    if (depth > all_.deepest[i].depth) all_.deepest[i] = {depth, time};
  }

  Penetrations all_;
  std::vector<double> radius_;  // radius of each obstacle; infinite where its shape has none [m]
  double edge_, depth_ = 0, at_ = 0, obstacle_ = 0, inside_ = -1, inside_at_ = 0;
};

}  // namespace plica::app
