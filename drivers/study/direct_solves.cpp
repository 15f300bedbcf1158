// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <plica/core/error.hpp>
#include <plica/drivers/elastic/materials.hpp>
#include <plica/drivers/study/direct_solves.hpp>
#include <stdexcept>

namespace plica {

void require_sound(Simulation<HostBackend>& simulation) {
  if (const auto bad = simulation.check()) throw std::runtime_error(bad->text());
}

namespace {

/// Returns for each vertex the vertices of its elements, including itself.
std::vector<std::vector<int>> neighbours_in(const TetMesh& mesh) {
  std::vector<std::vector<int>> lists(mesh.vertices.size());
  for (const auto& tet : mesh.tets)
    for (const int a : tet)
      lists[static_cast<std::size_t>(a)].insert(lists[static_cast<std::size_t>(a)].end(),
                                                tet.begin(), tet.end());
  for (auto& list : lists) {
    std::ranges::sort(list);
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  return lists;
}

/// Colours the vertices so that two of one colour have no neighbour in common. One product with the
/// matrix then gives the columns of all vertices of a colour (Curtis, Powell & Reid 1974).
std::vector<std::vector<int>> colour(const std::vector<std::vector<int>>& neighbours) {
  std::vector<int> colour_of(neighbours.size(), -1);
  std::vector<std::vector<int>> colours;
  std::vector<char> taken;
  for (std::size_t a = 0; a < neighbours.size(); ++a) {
    taken.assign(colours.size() + 1, 0);
    for (const int b : neighbours[a])
      for (const int c : neighbours[static_cast<std::size_t>(b)])
        if (const int used = colour_of[static_cast<std::size_t>(c)]; used >= 0)
          taken[static_cast<std::size_t>(used)] = 1;
    const auto mine = static_cast<std::size_t>(std::ranges::find(taken, 0) - taken.begin());
    if (mine == colours.size()) colours.emplace_back();
    colours[mine].push_back(static_cast<int>(a)), colour_of[a] = static_cast<int>(mine);
  }
  return colours;
}

/// Caps the bulk moduli of a law of tissue so that nu is 1/3 at most.
void cap_bulk_modulus(Body& body) {
  const MaterialInfo& info = *find_material(body.material.model);
  if (!info.of_tissue) return;
  const auto cap = [&](std::map<std::string, double>& parameters, const RegionOptions& region) {
    const Lame<double> rest = info.small_strains(parameter_values(info, body.material, region));
    parameters[parameter::bulk_modulus.name] = std::min(rest.lambda, 2 * rest.mu) + 2 * rest.mu / 3;
  };
  for (auto& [name, region] : body.regions) cap(region.parameters, region);
  cap(body.material.parameters, {});
}

/// Returns the body with linear elements and nu of 1/3 at most, so that they do not lock. Null
/// where the elements of `nodal` are linear already.
std::unique_ptr<LevelProbe<HostBackend>> linear_beside(const Problem& nodal) {
  if (element_of(nodal.body, 0) == Element::linear) return nullptr;
  Problem p = nodal;
  p.body.element = {"linear"};
  const auto cap = [](double& young, double& poisson) {  // at constant mu
    const double mu = young / (2 * (1 + poisson));
    poisson = std::min(poisson, 1.0 / 3), young = 2 * mu * (1 + poisson);
  };
  const double young = p.body.material.young_modulus, poisson = p.body.material.poisson_ratio;
  cap(p.body.material.young_modulus, p.body.material.poisson_ratio);
  for (auto& [name, region] : p.body.regions) {
    double E = region.young_modulus.value_or(young), nu = region.poisson_ratio.value_or(poisson);
    cap(E, nu);
    region.young_modulus = E, region.poisson_ratio = nu;
  }
  cap_bulk_modulus(p.body);
  return std::make_unique<LevelProbe<HostBackend>>(p);
}

}  // namespace

SparseStiffness::SparseStiffness(LevelProbe<HostBackend>& probe, const Held& held)
    : probe_(probe),
      linear_(linear_beside(probe.problem)),
      mass_(probe.mass()),
      neighbours_(neighbours_in(probe.built.meshes[0])),
      colours_(colour(neighbours_)) {
  const std::vector<Point>& rest = probe.built.meshes[0].vertices;
  for (const int dof : probe.free())
    if (!held || !held(rest[static_cast<std::size_t>(dof / 3)], dof % 3)) free_.push_back(dof);
  probe.force(probe.zero());
  linearise(probe.zero());
}

void SparseStiffness::linearise(const std::vector<Point>& u) {
  LevelProbe<HostBackend>& probe = linear_ ? *linear_ : probe_;
  at_ = u;
  if (linear_ && matrix_.rows() > 0)
    return;  // K at rest is kept: linear elements may be inverted where nodal ones are not
  std::vector<Eigen::Index> row_of(3 * mass_.size(), -1);
  const auto n = static_cast<Eigen::Index>(free_.size());
  for (Eigen::Index r = 0; r < n; ++r)
    row_of[static_cast<std::size_t>(free_[static_cast<std::size_t>(r)])] = r;
  std::vector<Eigen::Triplet<double>> entries;
  auto p = probe_.zero();
  for (const auto& together : colours_)
    for (std::size_t k = 0; k < 3; ++k) {
      for (const int b : together) p[static_cast<std::size_t>(b)][static_cast<Eigen::Index>(k)] = 1;
      const auto columns = linear_ ? probe.stiffness(u, p) : probe.tangent(u, p);
      for (const int b : together) {
        p[static_cast<std::size_t>(b)].setZero();
        const Eigen::Index column = row_of[3 * static_cast<std::size_t>(b) + k];
        for (const int a : neighbours_[static_cast<std::size_t>(b)])
          for (std::size_t i = 0; i < 3 && column >= 0; ++i)
            if (const Eigen::Index r = row_of[3 * static_cast<std::size_t>(a) + i]; r >= 0)
              entries.emplace_back(
                  r, column, columns[static_cast<std::size_t>(a)][static_cast<Eigen::Index>(i)]);
      }
    }
  matrix_.resize(n, n);
  matrix_.setFromTriplets(entries.begin(), entries.end());
  solver_.compute(matrix_);
}

Eigen::VectorXd SparseStiffness::part(const std::vector<Point>& field) const {
  Eigen::VectorXd x(matrix_.rows());
  for (Eigen::Index r = 0; r < x.size(); ++r) x[r] = field[vertex(r)][axis(r)];
  return x;
}

std::vector<Point> SparseStiffness::field(const Eigen::VectorXd& x) const {
  std::vector<Point> f(mass_.size(), Point::Zero());
  for (Eigen::Index r = 0; r < x.size(); ++r) f[vertex(r)][axis(r)] = x[r];
  return f;
}

std::vector<Point> SparseStiffness::equilibrium(const std::vector<Point>& force) const {
  return field(solve(solver_, part(force)));
}

Eigen::VectorXd SparseStiffness::masses() const {
  Eigen::VectorXd m(matrix_.rows());
  for (Eigen::Index r = 0; r < m.size(); ++r) m[r] = mass_[vertex(r)];
  return m;
}

Eigen::VectorXd SparseStiffness::solve(const Factor& factor, const Eigen::VectorXd& b,
                                       double shift) const {
  if (!linear_) return factor.solve(b);
  const Eigen::VectorXd shifted = shift * masses();
  Eigen::VectorXd x = Eigen::VectorXd::Zero(b.size()), r = b, z = factor.solve(r), p = z;
  double rz = r.dot(z);
  for (int i = 0; i < 5000 && r.norm() > 1e-12 * b.norm(); ++i) {
    const Eigen::VectorXd q = part(probe_.tangent(at_, field(p))) + shifted.cwiseProduct(p);
    if (!(p.dot(q) > 0)) break;
    const double alpha = rz / p.dot(q);
    x += alpha * p, r -= alpha * q;
    z = factor.solve(r);
    const double next = r.dot(z);
    p = z + next / rz * p, rz = next;
  }
  return x;
}

double SparseStiffness::lowest_frequency(std::vector<Point>& shape) const {
  const Eigen::VectorXd m = masses();
  Eigen::VectorXd x = part(shape);
  double w2 = 0;
  for (int i = 0; i < 200; ++i) {
    const Eigen::VectorXd y = solve(solver_, m.cwiseProduct(x));
    const double next = x.dot(m.cwiseProduct(x)) / x.dot(m.cwiseProduct(y));
    x = y / y.norm();
    if (std::abs(next - w2) < 1e-12 * next) break;
    w2 = next;
  }
  shape = field(x / x.cwiseAbs().maxCoeff());
  return std::sqrt(w2) / (2 * std::numbers::pi);
}

std::vector<double> SparseStiffness::frequencies(int count, double shift) const {
  const Eigen::VectorXd root = masses().cwiseSqrt();
  Factor of_shifted;
  if (shift != 0) {
    Matrix shifted = matrix_;
    shifted.diagonal() += shift * root.cwiseAbs2();
    of_shifted.compute(shifted);
  }
  const Factor& factor = shift != 0 ? of_shifted : solver_;
  const auto inverse = [&](const Eigen::VectorXd& x) -> Eigen::VectorXd {
    return root.cwiseProduct(solve(factor, root.cwiseProduct(x), shift));
  };
  std::vector<double> list;
  for (const double w2 : lowest_eigenvalues(inverse, root.size(), count))
    list.push_back(std::sqrt(std::max(0.0, w2 - shift)) / (2 * std::numbers::pi));
  return list;
}

namespace {

constexpr int most_iterations = 40, most_halvings = 12;
// residual over the largest one below which the body is at rest, where it does not fall further
constexpr double round_off = 1e-8;

class Newton {
 public:
  Newton(LevelProbe<HostBackend>& probe, const StaticOptions& options)
      : probe_(probe), options_(options), stiffness_(probe, options.held) {}

  std::vector<Point> to(double time, std::vector<Point> u) {
    double size = residual(u, time).norm();
    largest_ = std::max(largest_, size);
    double before = std::numeric_limits<double>::infinity();
    first_ = size;
    for (int i = 0; i < most_iterations; ++i) {
      if (size <= options_.relative_residual * largest_) return u;
      if (size <= round_off * largest_ && size > 0.5 * before) return u;
      before = size;
      stiffness_.linearise(u);
      const auto change = stiffness_.equilibrium(forces(u, time));
      const auto moved = search(u, change, time, size);
      if (!moved && size <= round_off * largest_) return u;
      if (!moved) break;
      u = *moved;
    }
    throw std::runtime_error("Newton's method leaves a residual of " +
                             std::to_string(size / largest_));
  }

 private:
  LevelProbe<HostBackend>& probe_;
  const StaticOptions& options_;
  SparseStiffness stiffness_;
  double largest_ = 0, first_ = 0;  ///< largest residual of all, first residual of this load step

  std::vector<Point> forces(const std::vector<Point>& u, double time) {
    auto f = probe_.force(u, probe_.zero(), time);
    for (std::size_t a = 0; a < options_.force.size(); ++a) f[a] += options_.force[a];
    return f;
  }
  Eigen::VectorXd residual(const std::vector<Point>& u, double time) {
    return stiffness_.part(forces(u, time));
  }

  // Returns the first of u + change, u + change/2 ... with a smaller residual. With nodal elements
  // the residual may be a thousand times the first one. Near incompressibility their smoothed
  // volumes are stiff, and a step that converges first raises the residual that much
  std::optional<std::vector<Point>> search(const std::vector<Point>& u,
                                           const std::vector<Point>& change, double time,
                                           double& size) {
    double step = 1;
    const bool nodal = probe_.at(0).model.rows.slices > 0;
    const double allowed = nodal ? std::max(size, 1e3 * first_) : size;
    for (int i = 0; i < most_halvings; ++i, step /= 2) {
      auto moved = u;
      for (std::size_t a = 0; a < u.size(); ++a) moved[a] += step * change[a];
      const double next = residual(moved, time).norm();
      if (!(next < allowed)) continue;
      size = next;
      return moved;
    }
    return {};
  }
};

}  // namespace

std::vector<Point> static_equilibrium(LevelProbe<HostBackend>& probe,
                                      const StaticOptions& options) {
  Newton newton(probe, options);
  std::vector<Point> u = options.start.empty() ? probe.zero() : options.start;
  for (int s = 1; s <= options.load_steps; ++s)
    u = newton.to(double(s) / options.load_steps, std::move(u));
  return u;
}

double frequency_of_motion(const Problem& problem, const std::vector<Point>& shape,
                           double amplitude, int periods, double guess) {
  Simulation<HostBackend> simulation(problem);
  std::size_t tip = 0;
  for (std::size_t a = 0; a < shape.size(); ++a)
    if (shape[a].norm() > shape[tip].norm()) tip = a;
  std::vector<Point> u = shape;
  for (Point& p : u) p *= amplitude / shape[tip].norm();
  simulation.set_state(u, std::vector<Point>(u.size(), Point::Zero()));
  const Point direction = shape[tip].normalized();
  const auto displacement = simulation.displacement();
  double before = amplitude, first = -1, last = -1;
  int crossings = 0;
  while (simulation.time() < (periods + 1) / guess) {
    simulation.step();
    Kokkos::fence("plica::frequency_of_motion");
    double now = 0;
    for (int k = 0; k < 3; ++k)
      now += direction[k] * displacement(tip, static_cast<std::size_t>(k));
    if (before > 0 && now <= 0) {
      last = simulation.time() - simulation.macro_step() * now / (now - before);
      if (crossings++ == 0) first = last;
    }
    before = now;
  }
  require_sound(simulation);
  return (crossings - 1) / (last - first);
}

}  // namespace plica
