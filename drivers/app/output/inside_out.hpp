// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <plica/core/problem.hpp>
#include <plica/core/text.hpp>
#include <plica/drivers/elastic/materials.hpp>
#include <plica/drivers/run/simulation.hpp>
#include <string>
#include <vector>

namespace plica::app {

/// Detects inverted elements (J <= 0) in the frames of a run. It looks only where the material
/// allows inversion and the scene does not ask for it.
class InsideOut {
 public:
  explicit InsideOut(const MaterialOptions& material)
      : material_(material.model),
        looks_(allows_inversion(material) && !material.allow_inversion) {}

  /// Returns true if frames have to be looked at.
  bool looks() const { return looks_; }

  /// Takes in the volume ratios J of the frame at this time [s].
  void look(double time, const ElementFields& fields) {
    const auto count =
        static_cast<double>(std::ranges::count_if(fields.J, [](double J) { return J <= 0; }));
    if (count == 0) return;
    if (most_ == 0) first_ = time;
    least_ = std::min(least_, *std::ranges::min_element(fields.J));
    if (count > most_)
      most_ = count, at_ = time, all_ = static_cast<double>(fields.J.size()),
      per_vertex_ = fields.per_vertex;
  }

  /// Returns the values that restore() needs in a resumed run.
  std::vector<double> save() const {
    return {most_, all_, first_, at_, least_, per_vertex_ ? 1.0 : 0.0};
  }
  /// Restores the values that save() has returned. Throws InputError for another number of them.
  void restore(const std::vector<double>& saved) {
    expect_saved("inverted elements", saved.size(), 6);
    most_ = saved[0], all_ = saved[1], first_ = saved[2], at_ = saved[3], least_ = saved[4],
    per_vertex_ = saved[5] > 0;
  }

  /// Returns a warning if there were inverted elements; empty: there were none.
  std::string warning() const {
    if (most_ == 0) return {};
    return text(
        "body.material: elements turned inside out, first at ", number(first_, 4), " s; at ",
        number(at_, 4), " s ", per_vertex_ ? "those around " : "", static_cast<long>(most_), " of ",
        static_cast<long>(all_), per_vertex_ ? " vertices" : " elements", " were, with J down to ",
        number(least_, 3), ". ", material_,
        " does not stop the run there, but tissue cannot do this: expected a material that does, "
        "such as "
        "neo_hookean, or allow_inversion: false; allow_inversion: true leaves out this warning");
  }

 private:
  std::string material_;
  bool looks_, per_vertex_ = false;
  double most_ = 0, all_ = 0, first_ = 0, at_ = 0, least_ = 0;
};

}  // namespace plica::app
