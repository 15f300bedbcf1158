// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/cycles/him/him_stepper.hpp>
#include <plica/drivers/elastic/largest_eigenvalue.hpp>
#include <plica/drivers/spaces/coarse_spaces.hpp>
#include <plica/drivers/spaces/coarse_stiffness.hpp>
#include <plica/drivers/study/level_probe.hpp>
#include <plica/kernels/materials/material.hpp>

#include "support/backends.hpp"

#include "support/bodies.hpp"

// A beam for the cycle him, and what that cycle is made of.
namespace plica::test {

inline Problem him_beam(bool nested, const std::string& material = "linear") {
  std::vector<TetMesh> levels = {box_mesh(beam_box, {8, 4, 4})};
  levels.push_back(nested ? box_mesh(beam_box, {4, 2, 2}) : jittered_box(beam_box, {5, 3, 3}));
  levels.push_back(nested ? box_mesh(beam_box, {2, 1, 1}) : jittered_box(beam_box, {3, 2, 2}));
  Problem p = body_of(std::move(levels), material);
  p.integration.cycle = "him";
  return p;
}

inline TetMesh irregular_beam() { return with_slivers(jittered_box(beam_box, {20, 5, 5}, 0.2)); }

/// The same beam as one irregular mesh, with slivers, whose coarser levels are made of it.
inline Problem him_beam_alone(const std::string& material = "linear") {
  Problem p = him_beam(false, material);
  p.body.levels = {with_slivers(jittered_box(beam_box, {16, 4, 4}))};
  p.body.coarsen = {150, 40};
  return p;
}

/// Level 0, the inverse mass above it and its fit, put together by hand.
struct Pieces {
  explicit Pieces(const Problem& problem)
      : levels(problem.body.levels), probe([&] {
          Problem alone = problem;
          alone.integration.cycle = "single", alone.integration.macro_step = 1e-9;
          return alone;
        }()) {
    const LevelData<Host>& level = probe.at(0);
    std::vector<std::vector<char>> constrained;
    for (std::size_t i = 0; i < levels.size(); ++i) {
      constrained.emplace_back(levels[i].vertices.size(), 0);
      for (std::size_t a = 0; a < levels[i].vertices.size() && !problem.body.fixed.empty(); ++a)
        constrained[i][a] = levels[i].vertices[a][0] < 1e-9;
      up.push_back(i == 0 ? Embedding{}
                          : embed(levels[i - 1].vertices, levels[i], Outside::extrapolate));
    }
    std::vector<RowMatrix> transfers;
    for (std::size_t i = 1; i < levels.size(); ++i)
      transfers.push_back(transfer_matrix(levels[i - 1], constrained[i - 1], levels[i],
                                          constrained[i], up[i], true));
    const MaterialOptions& m = problem.body.material;
    const Lame<double> lame = lame_constants(m.young_modulus, m.poisson_ratio);
    const std::vector<std::array<double, 2>> constants{{lame.lambda, lame.mu}};
    const bool made = levels.size() == 1;
    if (made)
      for (CoarseSpace& space : coarse_spaces(
               levels[0], constrained[0], probe.mass(), rest_stiffness(levels[0], constants),
               {.sizes = space_sizes(problem.body.coarsen, constrained[0]), .slivers = true}))
        transfers.push_back(std::move(space.up));
    const auto spaces = mass_spaces(transfers, probe.mass());
    const RowMatrix whole = to_finest(spaces);
    inverse_mass = std::make_unique<InverseMass<Host>>(
        level.model.inverse_mass, spaces,
        made ? frames_of_space(levels.front(), whole, probe.mass())
             : frames_of_mesh(levels.front(), levels.back(), probe.mass()));
    const std::shared_ptr<const Elasticity<Host>> elasticity =
        make_elasticity<Host>(problem.body.material.model);
    const Vectors<Host> rest("rest", levels[0].vertices.size());
    fitter = std::make_unique<InertiaFitter<Host>>(
        typename Host::Exec{}, level, RowsOfBody{0, level.model.vertices}, elasticity,
        largest_eigenvalue<Host>({}, {level, *elasticity, rest}), *inverse_mass,
        CoarseModes(coarse_stiffness(levels[0], constants, whole), spaces.back().mass));
  }

  Eigen::MatrixXd matrix() {
    const auto n = static_cast<Eigen::Index>(3 * levels[0].vertices.size());
    Eigen::MatrixXd A(n, n);
    std::vector<Point> f(levels[0].vertices.size(), Point::Zero());
    const Vectors<Host> a("a", f.size());
    for (Eigen::Index j = 0; j < n; ++j) {
      f[static_cast<std::size_t>(j / 3)][j % 3] = 1;
      inverse_mass->apply({}, device_field<Host>(f), a);
      f[static_cast<std::size_t>(j / 3)][j % 3] = 0;
      const auto column = to_host<Host>({}, a);
      for (Eigen::Index r = 0; r < n; ++r) A(r, j) = column[static_cast<std::size_t>(r / 3)][r % 3];
    }
    return A;
  }

  std::optional<InertiaFit> fit(double over_critical, double sigma = 0.8) {
    const Vectors<Host> rest("rest", levels[0].vertices.size());
    return fitter->fit(over_critical * fitter->critical_steps()[0], sigma, rest);
  }

  std::vector<TetMesh> levels;
  LevelProbe<Host> probe;
  std::vector<Embedding> up;
  std::unique_ptr<InverseMass<Host>> inverse_mass;
  std::unique_ptr<InertiaFitter<Host>> fitter;
};

}  // namespace plica::test
