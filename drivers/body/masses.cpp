// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <numeric>
#include <plica/core/to_device.hpp>
#include <plica/drivers/body/masses.hpp>
#include <plica/meshes/composite.hpp>

namespace plica {

std::vector<double> region_densities(const Body& body, const TetMesh& mesh) {
  if (mesh.region.empty()) return {body.material.density};
  std::vector<double> density;
  for (const std::string& name : mesh.region_names) {
    const auto own = body.regions.find(name);
    density.push_back(own == body.regions.end()
                          ? body.material.density
                          : own->second.density.value_or(body.material.density));
  }
  return density;
}

std::vector<double> lumped_masses(const TetMesh& mesh, const std::vector<double>& density) {
  std::vector<double> mass(mesh.vertices.size(), 0);
  for (std::size_t e = 0; e < mesh.tets.size(); ++e) {
    const auto& t = mesh.tets[e];
    const auto x = [&](std::size_t k) -> const Point& {
      return mesh.vertices[static_cast<std::size_t>(t[k])];
    };
    const double of_tet =
        density[mesh.region.empty() ? 0 : static_cast<std::size_t>(mesh.region[e])];
    const double volume = mesh.part(e) * tet_volume(x(0), x(1), x(2), x(3));
    for (int v : t) mass[static_cast<std::size_t>(v)] += of_tet * volume / 4;
  }
  give_to_masters(mesh.followers, mass);
  return mass;
}

std::vector<PieceReport> piece_reports(const TetMesh& mesh, const std::vector<double>& density) {
  std::vector<PieceReport> pieces;
  std::vector<int> piece_of(mesh.vertices.size(), 0);
  for (std::size_t e = 0; e < mesh.piece.size(); ++e) {
    const auto piece = static_cast<std::size_t>(mesh.piece[e]);
    if (piece >= pieces.size()) pieces.resize(piece + 1);
    const auto x = corners_of(mesh, static_cast<int>(e));
    PieceReport& one = pieces[piece];
    ++one.tets;
    one.cut += mesh.part(e) < 1 ? 1 : 0;
    one.mass += density[mesh.region.empty() ? 0 : static_cast<std::size_t>(mesh.region[e])] *
                mesh.part(e) * tet_volume(x[0], x[1], x[2], x[3]);
    one.least_filled = std::min(one.least_filled, mesh.part(e));
    for (const int v : mesh.tets[e]) piece_of[static_cast<std::size_t>(v)] = mesh.piece[e];
  }
  for (std::size_t i = 0; i < std::min(pieces.size(), mesh.covered.size()); ++i)
    pieces[i].dropped = mesh.covered[i].dropped, pieces[i].covered = mesh.covered[i].volume;
  for (const int v : mesh.followers.vertex)
    ++pieces[static_cast<std::size_t>(piece_of[static_cast<std::size_t>(v)])].followers;
  return pieces;
}

std::vector<double> inherited_masses(const Embedding& up, const std::vector<double>& fine,
                                     const std::vector<double>& own, int& without) {
  std::vector<double> mass(own.size(), 0);
  for (std::size_t a = 0; a < fine.size(); ++a)
    for (std::size_t c = 0; c < 4; ++c)
      mass[static_cast<std::size_t>(up.vertices[a][c])] += up.weights[a][c] * fine[a];
  const double total = std::accumulate(mass.begin(), mass.end(), 0.0);
  without = 0;
  for (std::size_t a = 0; a < mass.size(); ++a)
    if (!(mass[a] > 1e-6 * own[a])) mass[a] = own[a], ++without;
  const double scale = total / std::accumulate(mass.begin(), mass.end(), 0.0);
  if (without > 0)
    for (double& m : mass) m *= scale;
  return mass;
}

std::vector<RestrictionRow> restriction_rows(const Embedding& up, const std::vector<double>& fine,
                                             const Embedding& down) {
  struct Entry {
    int source;
    double weight, average;
  };
  std::vector<std::vector<Entry>> of(down.weights.size());
  for (std::size_t a = 0; a < up.weights.size(); ++a)
    for (std::size_t c = 0; c < 4; ++c)
      if (const double w = up.weights[a][c]; w != 0)
        of[static_cast<std::size_t>(up.vertices[a][c])].push_back(
            {static_cast<int>(a), w, w * fine[a]});
  std::vector<RestrictionRow> rows;
  for (std::size_t a = 0; a < of.size(); ++a) {
    if (of[a].empty()) {
      for (std::size_t c = 0; c < 4; ++c)
        of[a].push_back({down.vertices[a][c], 0, down.weights[a][c]});
      std::ranges::sort(of[a], {}, &Entry::source);
    }
    double total = 0;
    for (const Entry& e : of[a]) total += e.average;
    RestrictionRow& row = rows.emplace_back();
    for (const Entry& e : of[a]) {
      row.source.push_back(e.source);
      row.weight.push_back(e.weight);
      row.average.push_back(e.average / total);
    }
  }
  return rows;
}

template <class B>
Restriction<B> build_restriction(const std::vector<RestrictionRow>& rows) {
  using Real = typename B::Real;
  std::vector<int> first{0}, source;
  std::vector<Real> weight, average;
  for (const RestrictionRow& row : rows) {
    source.insert(source.end(), row.source.begin(), row.source.end());
    for (const double w : row.weight) weight.push_back(static_cast<Real>(w));
    for (const double w : row.average) average.push_back(static_cast<Real>(w));
    first.push_back(static_cast<int>(source.size()));
  }
  Restriction<B> r;
  r.rows = static_cast<int>(rows.size());
  r.first = to_device<Indices<B>>("restriction.first", first);
  r.source = to_device<Indices<B>>("restriction.source", source);
  r.weight = to_device<Scalars<B>>("restriction.weight", weight);
  r.average = to_device<Scalars<B>>("restriction.average", average);
  return r;
}

#define PLICA_INSTANTIATE(Real, Exec)                                               \
  template Restriction<Backend<Real, Exec>> build_restriction<Backend<Real, Exec>>( \
      const std::vector<RestrictionRow>&);
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
