// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <plica/core/problem.hpp>
#include <plica/core/text.hpp>
#include <string>
#include <vector>

namespace plica::app {

/// Looks whether obstacles come visibly deep into the surface, or through it: contact is by penalties, and too soft a one lets a tool sink in.
class ContactDepth {
 public:
  static constexpr double visible = 0.5;  ///< of a mean edge

  /// @param edge  mean one of the finest level [m]
  ContactDepth(const ContactOptions& contact, double edge) : edge_(edge) {
    for (std::size_t o = 0; o < contact.obstacles.size(); ++o) names_.push_back(obstacle_name(contact, o));
  }

  bool looks() const { return !names_.empty(); }

  /// At this time [s]; depths of all obstacles [m], and what obstacles_inside() says.
  void look(double time, const std::vector<double>& depths, const std::vector<int>& inside) {
    if (inside_ < 0 && !inside.empty()) inside_ = inside.front(), inside_at_ = time;
    for (std::size_t o = 0; o < depths.size(); ++o)
      if (depths[o] > depth_) depth_ = depths[o], at_ = time, obstacle_ = static_cast<double>(o);
  }

  /// What there is to go on from, and going on from it.
  std::vector<double> save() const { return {depth_, at_, obstacle_, inside_, inside_at_}; }
  void restore(const std::vector<double>& saved) {
    if (saved.size() < 5) return;
    depth_ = saved[0], at_ = saved[1], obstacle_ = saved[2], inside_ = saved[3], inside_at_ = saved[4];
  }

  /// A sentence where one was, else nothing.
  std::string warning() const {
    if (inside_ >= 0)
      return text(
          "contact: at ", number(inside_at_, 4), " s ", names_.at(static_cast<std::size_t>(inside_)),
          " was inside the body and touched nothing: it has come through the surface, and the body does not feel "
          "it there; expected a slower obstacle, a smaller integration.macro_step, or contact.stiffness_scale "
          "above 1");
    if (!(depth_ > visible * edge_)) return {};
    return text("contact: at ", number(at_, 4), " s ", names_.at(static_cast<std::size_t>(obstacle_)), " was ",
                number(depth_, 3), " m deep in the surface, ", number(depth_ / edge_, 3),
                " of a mean edge: its force is less than that of a hard one; expected contact.stiffness_scale above 1, "
                "which on implicit levels needs a smaller integration.macro_step, or a slower obstacle");
  }

 private:
  std::vector<std::string> names_;
  double edge_, depth_ = 0, at_ = 0, obstacle_ = 0, inside_ = -1, inside_at_ = 0;
};

}  // namespace plica::app
