// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/solver/him/him_stepper.hpp>
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

/// Level 0, the inverse mass above it and its fit, put together by hand.
struct Pieces {
  explicit Pieces(const Problem& problem)
      : levels(problem.body.levels), probe([&] {
          Problem alone = problem;
          alone.integration.cycle = "single", alone.integration.macro_step = 1e-9;
          return alone;
        }()) {
    const Level<Host>& level = probe.at(0);
    std::vector<std::vector<char>> constrained;
    for (std::size_t i = 0; i < levels.size(); ++i) {
      constrained.emplace_back(levels[i].vertices.size(), 0);
      for (std::size_t a = 0; a < levels[i].vertices.size() && !problem.body.fixed.empty(); ++a)
        constrained[i][a] = levels[i].vertices[a][0] < 1e-9;
      up.push_back(i == 0 ? Embedding{} : embed(levels[i - 1].vertices, levels[i], Outside::extrapolate));
    }
    std::vector<MassMesh> meshes;
    for (std::size_t i = 0; i < levels.size(); ++i) meshes.push_back({levels[i], constrained[i], up[i]});
    const auto spaces = mass_spaces(meshes, probe.mass(), true);
    const MaterialOptions& m = problem.body.material;
    const Lame<double> lame = lame_constants(m.young_modulus, m.poisson_ratio);
    const Eigen::MatrixXd K = coarse_stiffness(levels[0], {{lame.lambda, lame.mu}}, to_finest(spaces));
    Eigen::MatrixXd M = Eigen::MatrixXd::Zero(K.rows(), K.cols());
    for (Eigen::Index a = 0; a < spaces.back().mass.rows(); ++a)
      for (RowMatrix::InnerIterator e(spaces.back().mass, a); e; ++e)
        for (int k = 0; k < 3; ++k) M(3 * a + k, 3 * e.col() + k) = e.value();
    inverse_mass = std::make_unique<InverseMass<Host>>(level, levels.front(), levels.back(), spaces);
    fitter = std::make_unique<InertiaFitter<Host>>(typename Host::Exec{}, level,
                                                   make_elasticity<Host>(problem.body.material.model), *inverse_mass,
                                                   CoarseModes(K, M));
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
