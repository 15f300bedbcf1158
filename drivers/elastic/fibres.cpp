// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Eigenvalues>
#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <plica/core/error.hpp>
#include <plica/core/to_device.hpp>
#include <plica/drivers/body/selection.hpp>
#include <plica/drivers/elastic/fibres.hpp>
#include <plica/kernels/materials/material.hpp>
#include <plica/meshes/embedding.hpp>
#include <plica/meshes/tet_gradients.hpp>

namespace plica {

namespace {

const Point& corner_of(const TetMesh& mesh, std::size_t tet, std::size_t corner) {
  return mesh.vertices[static_cast<std::size_t>(mesh.tets[tet][corner])];
}

double volume_of(const TetMesh& mesh, std::size_t t) {
  return mesh.part(t) * tet_volume(corner_of(mesh, t, 0), corner_of(mesh, t, 1),
                                   corner_of(mesh, t, 2), corner_of(mesh, t, 3));
}

/// Returns the given temperature of each vertex: 0, 1, or NaN where it is free.
std::vector<double> given_temperatures(const TetMesh& mesh, const Selection& from,
                                       const Selection& to, const std::string& path) {
  const double free = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> given(mesh.vertices.size(), free);
  for (const int v : select_vertices(mesh, from, {path + ".from", 0}))
    given[static_cast<std::size_t>(v)] = 0;
  for (const int v : select_vertices(mesh, to, {path + ".to", 0})) {
    double& value = given[static_cast<std::size_t>(v)];
    if (value == 0)
      throw InputError(path + ".to: vertex " + std::to_string(v) +
                       " of level 0 is in `from` as well; expected sets apart");
    value = 1;
  }
  return given;
}

/// Solves for the free temperatures: int grad w . grad T = 0 for every w that is 0 where T is
/// given.
std::vector<double> temperatures(const TetMesh& mesh, std::vector<double> T) {
  std::vector<int> unknown(T.size(), -1);
  int count = 0;
  for (std::size_t v = 0; v < T.size(); ++v)
    if (std::isnan(T[v])) unknown[v] = count++;
  if (count == 0) return T;
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd b = Eigen::VectorXd::Zero(count);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const Eigen::Matrix<double, 3, 4> g = TetGradients(mesh, t).gradient.transpose();
    const Eigen::Matrix4d K = volume_of(mesh, t) * g.transpose() * g;
    for (int i = 0; i < 4; ++i) {
      const int row = unknown[static_cast<std::size_t>(mesh.tets[t][static_cast<std::size_t>(i)])];
      for (int j = 0; row >= 0 && j < 4; ++j) {
        const auto w = static_cast<std::size_t>(mesh.tets[t][static_cast<std::size_t>(j)]);
        if (unknown[w] >= 0)
          entries.emplace_back(row, unknown[w], K(i, j));
        else
          b[row] -= K(i, j) * T[w];
      }
    }
  }
  Eigen::SparseMatrix<double> A(count, count);
  A.setFromTriplets(entries.begin(), entries.end());
  Eigen::ConjugateGradient<Eigen::SparseMatrix<double>, Eigen::Lower | Eigen::Upper> solver(A);
  solver.setTolerance(1e-12);
  const Eigen::VectorXd x = solver.solve(b);
  for (std::size_t v = 0; v < T.size(); ++v)
    if (unknown[v] >= 0) T[v] = x[unknown[v]];
  return T;
}

/// Gives elements without a direction the mean direction of those that share a vertex with them.
/// Each call reaches one layer of elements. Returns false where no such element got a direction.
bool take_from_neighbours(const TetMesh& mesh, std::vector<Point>& direction) {
  std::vector<Point> at_vertex(mesh.vertices.size(), Point::Zero());
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    for (const int v : mesh.tets[t]) at_vertex[static_cast<std::size_t>(v)] += direction[t];
  bool found = false;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    if (!direction[t].isZero(0)) continue;
    for (const int v : mesh.tets[t]) direction[t] += at_vertex[static_cast<std::size_t>(v)];
    if (direction[t].norm() > 0) direction[t].normalize(), found = true;
  }
  return found;
}

}  // namespace

std::vector<Point> flow_directions(const TetMesh& mesh, const Selection& from, const Selection& to,
                                   const std::string& path) {
  const std::vector<double> T = temperatures(mesh, given_temperatures(mesh, from, to, path));
  const Box box = bounding_box(mesh.vertices);
  const double nothing = 1e-9 / (box.max - box.min).norm();
  std::vector<Point> direction;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    Eigen::Vector4d at;
    for (int k = 0; k < 4; ++k)
      at[k] = T[static_cast<std::size_t>(mesh.tets[t][static_cast<std::size_t>(k)])];
    const Point g = TetGradients(mesh, t).gradient.transpose() * at;
    direction.push_back(g.norm() > nothing ? g.normalized() : Point::Zero());
  }
  const auto none = [](const Point& d) { return d.isZero(0); };
  for (auto at = std::ranges::find_if(direction, none); at != direction.end();
       at = std::ranges::find_if(direction, none))
    if (!take_from_neighbours(mesh, direction))
      throw InputError(
          path + ": the part of the body with element " + std::to_string(at - direction.begin()) +
          " of level 0 touches only one of `from` and `to`, or none; expected fibres between both");
  return direction;
}

namespace {

Point centroid(const TetMesh& mesh, std::size_t tet) {
  Point sum = Point::Zero();
  for (const int v : mesh.tets[tet]) sum += mesh.vertices[static_cast<std::size_t>(v)];
  return sum / 4;
}

FibreAxes orthonormal(const Point& axis, const std::optional<Point>& sheet) {
  const Point a = axis.normalized();
  Point s = sheet.value_or(a.unitOrthogonal());
  s -= a.dot(s) * a;
  return {a, s.norm() > 1e-6 ? Point(s.normalized()) : a.unitOrthogonal()};
}

bool varies(const std::optional<FibreOptions>& o) {
  return o && (o->around || o->from || !o->field.empty() || !o->sheet_field.empty());
}

/// Returns the mesh of level 0 with the regions that selections choose.
TetMesh finest_with_regions(const Body& body) {
  TetMesh mesh = body.levels.front();
  const auto known = [&](const auto& region) {
    return region.second.where && std::ranges::count(mesh.region_names, region.first) > 0;
  };
  if (std::ranges::none_of(body.regions, known)) add_regions(mesh, body.regions, 0);
  return mesh;
}

/// Fields and flows that give the directions of a level's elements.
class FibreFields {
 public:
  FibreFields(const Body& body, const TetMesh& mesh, int level)
      : body_(body), finest_(body.levels.front()), mesh_(mesh), level_(level) {}

  Point at(const std::string& path, const std::string& name, std::size_t tet) {
    const auto own = mesh_.tet_vectors.find(name), first = finest_.tet_vectors.find(name);
    if (own != mesh_.tet_vectors.end()) return checked(path, name, level_, tet, own->second[tet]);
    if (first == finest_.tet_vectors.end()) {
      std::vector<std::string> known;
      for (const auto& [field, vectors] : finest_.tet_vectors) known.push_back(field);
      throw InputError(
          path + ": " +
          (known.empty() ? "the mesh of level 0 has no field of vectors; expected '" + name +
                               "' among those of its cells or points"
                         : unknown_name("field of vectors of the mesh of level 0", name, known)));
    }
    const std::size_t near = nearest(tet);
    return checked(path, name, 0, near, first->second[near]);
  }

  /// Returns the direction of an element in a flow between sets of vertices of level 0.
  const Point& flow(const std::string& path, const FibreOptions& o, std::size_t tet) {
    const auto [found, is_new] = flows_.try_emplace(path);
    if (is_new)
      found->second =
          flow_directions(level_ == 0 ? mesh_ : finest_with_regions(body_), *o.from, *o.to, path);
    return found->second[level_ == 0 ? tet : nearest(tet)];
  }

 private:
  const Body& body_;
  const TetMesh &finest_, &mesh_;
  int level_;
  std::unique_ptr<TetLocator> locator_;
  std::map<std::string, std::vector<Point>> flows_;

  std::size_t nearest(std::size_t tet) {
    if (!locator_) locator_ = std::make_unique<TetLocator>(finest_);
    return static_cast<std::size_t>(locator_->locate(centroid(mesh_, tet)).tet);
  }
  static const Point& checked(const std::string& path, const std::string& name, int level,
                              std::size_t tet, const Point& vector) {
    if (vector.allFinite() && vector.norm() > 0) return vector;
    throw InputError(path + ": field '" + name + "' has " +
                     (vector.allFinite() ? "length 0" : "no finite number") + " at element " +
                     std::to_string(tet) + " of level " + std::to_string(level) +
                     "; expected a direction at every element");
  }
};

}  // namespace

FibreAxes fibre_axes(const FibreOptions& o, const Point& at) {
  if (!o.around) return orthonormal(o.axis, o.sheet);
  const Point along = o.around->axis.normalized();
  Point out = at - o.around->point;
  out -= along.dot(out) * along;
  if (!(out.norm() > 0)) out = along.unitOrthogonal();  // the point is on the line
  const Point round = along.cross(out.normalized());
  const double c = std::cos(o.around->angle), s = std::sin(o.around->angle);
  return {c * round + s * along, c * along - s * round};
}

bool has_fibres(const Body& body) {
  return body.material.fibres || std::ranges::any_of(body.regions, [](const auto& region) {
           return region.second.fibres.has_value();
         });
}

bool fibres_vary(const Body& body) {
  return varies(body.material.fibres) || std::ranges::any_of(body.regions, [](const auto& region) {
           return varies(region.second.fibres);
         });
}

std::vector<FibreAxes> element_fibres(const Body& body, const TetMesh& mesh, int level) {
  std::vector<FibreAxes> all;
  FibreFields fields(body, mesh, level);
  for (std::size_t e = 0; e < mesh.tets.size(); ++e) {
    const std::string region =
        mesh.region.empty() ? "" : mesh.region_names[static_cast<std::size_t>(mesh.region[e])];
    const auto own = body.regions.find(region);
    const bool of_region = own != body.regions.end() && own->second.fibres;
    if (!of_region && !body.material.fibres) return {};
    FibreOptions o = of_region ? *own->second.fibres : *body.material.fibres;
    const std::string path = of_region ? "body.regions." + region + ".fibres" : "body.fibres";
    if (o.from) o.axis = fields.flow(path, o, e);
    if (!o.field.empty()) o.axis = fields.at(path + ".field", o.field, e);
    if (!o.sheet_field.empty()) o.sheet = fields.at(path + ".sheet_field", o.sheet_field, e);
    all.push_back(fibre_axes(o, centroid(mesh, e)));
  }
  return all;
}

void flows_to_fields(Body& body, const std::string& field) {
  std::vector<FibreOptions*> flows;
  const auto add = [&](std::optional<FibreOptions>& fibres) {
    if (fibres && fibres->from && fibres->to) flows.push_back(&*fibres);
  };
  add(body.material.fibres);
  for (auto& [name, region] : body.regions) add(region.fibres);
  if (flows.empty()) return;
  std::vector<std::vector<Point>> of_levels;
  for (std::size_t i = 0; i < body.levels.size(); ++i) {
    TetMesh mesh = body.levels[i];
    add_regions(mesh, body.regions, static_cast<int>(i));
    std::vector<Point>& directions = of_levels.emplace_back();
    for (const FibreAxes& axes : element_fibres(body, mesh, static_cast<int>(i)))
      directions.push_back(axes[0]);
  }
  for (std::size_t i = 0; i < of_levels.size(); ++i)
    body.levels[i].tet_vectors[field] = std::move(of_levels[i]);
  for (FibreOptions* o : flows) o->from.reset(), o->to.reset(), o->field = field;
}

void fields_to_levels(Body& body) {
  const TetMesh& finest = body.levels.front();
  if (finest.tet_vectors.empty() || body.levels.size() == 1) return;
  const TetLocator locator(finest);
  for (std::size_t i = 1; i < body.levels.size(); ++i) {
    TetMesh& mesh = body.levels[i];
    for (const auto& [name, vectors] : finest.tet_vectors) {
      const auto [own, is_new] = mesh.tet_vectors.try_emplace(name);
      for (std::size_t t = 0; is_new && t < mesh.tets.size(); ++t)
        own->second.push_back(
            vectors[static_cast<std::size_t>(locator.locate(centroid(mesh, t)).tet)]);
    }
  }
}

FibreAxes family_components(const MaterialInfo& law, std::vector<double> values) {
  TissueSettings s;
  s.axis[0] = 1, s.axis[1] = 0, s.axis[2] = 0;
  s.sheet[0] = 0, s.sheet[1] = 1, s.sheet[2] = 0;
  const std::vector<double> settings = as_list(s);
  std::ranges::copy(settings, values.end() - static_cast<std::ptrdiff_t>(settings.size()));
  const std::vector<double> constants = law.kernel_constants(values);  // end with both directions
  const double* const d = constants.data() + constants.size() - 6;
  return {Point(d[0], d[1], d[2]), Point(d[3], d[4], d[5])};
}

namespace {

/// Returns the directions that a law takes where fibre and sheet are `axes`.
FibreAxes as_families(const FibreAxes& axes, const FibreAxes& components) {
  if (components == FibreAxes{Point::UnitX(), Point::UnitY()}) return axes;
  Eigen::Matrix3d basis;
  basis << axes[0], axes[1], axes[0].cross(axes[1]);
  return {basis * components[0], basis * components[1]};
}

}  // namespace

template <class B>
Scalars<B> device_fibres(const Patches<B>& patches, const TetMesh& mesh,
                         const std::vector<FibreAxes>& of_tets,
                         const std::vector<FibreAxes>& families) {
  const auto element = on_host(patches.element);
  std::vector<typename B::Real> all;
  for (std::size_t slot = 0; slot < element.extent(0); ++slot) {
    FibreAxes axes{Point::UnitX(), Point::UnitY()};
    if (element(slot) >= 0) {
      const auto e = static_cast<std::size_t>(element(slot));
      const auto r = static_cast<std::size_t>(mesh.region.empty() ? 0 : mesh.region[e]);
      axes = as_families(of_tets[e], families[r]);
    }
    for (const Point& a : axes)
      for (int k = 0; k < 3; ++k) all.push_back(static_cast<typename B::Real>(a[k]));
  }
  return to_device<Scalars<B>>("patches.fibres", all);
}

template <class B>
Scalars<B> device_fibres(const NodalRows<B>& rows, const TetMesh& mesh,
                         const std::vector<FibreAxes>& of_tets,
                         const std::vector<FibreAxes>& families) {
  // Sums of V a a^T, because opposite directions are the same fibre.
  struct Sum {
    Eigen::Matrix3d axis = Eigen::Matrix3d::Zero(), sheet = Eigen::Matrix3d::Zero();
  };
  std::map<std::pair<int, int>, Sum> sums;  // region, vertex
  for (std::size_t e = 0; e < mesh.tets.size(); ++e) {
    const auto& t = mesh.tets[e];
    const auto x = [&](std::size_t c) -> const Point& {
      return mesh.vertices[static_cast<std::size_t>(t[c])];
    };
    const double volume = mesh.part(e) * tet_volume(x(0), x(1), x(2), x(3));
    const auto& [axis, sheet] = of_tets[e];
    for (const int v : t) {
      Sum& sum = sums[{mesh.region.empty() ? 0 : mesh.region[e], v}];
      sum.axis += volume * axis * axis.transpose(), sum.sheet += volume * sheet * sheet.transpose();
    }
  }
  const auto main_direction = [](const Eigen::Matrix3d& sum) {
    return Point(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(sum).eigenvectors().col(2));
  };
  const auto vertex = on_host(rows.vertex), region = on_host(rows.region);
  std::vector<typename B::Real> all;
  for (int slot = 0; slot < rows.slots(); ++slot) {
    FibreAxes axes{Point::UnitX(), Point::UnitY()};
    if (vertex(slot) >= 0) {
      const int in = region(slot / NodalRows<B>::height);
      const Sum& sum = sums.at({in, vertex(slot)});
      const Point axis = main_direction(sum.axis);
      const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - axis * axis.transpose();
      axes = as_families(orthonormal(axis, main_direction(across * sum.sheet * across)),
                         families[static_cast<std::size_t>(in)]);
    }
    for (const Point& a : axes)
      for (int k = 0; k < 3; ++k) all.push_back(static_cast<typename B::Real>(a[k]));
  }
  return to_device<Scalars<B>>("rows.fibres", all);
}

#define PLICA_INSTANTIATE(Real, Exec)                                                       \
  template Scalars<Backend<Real, Exec>> device_fibres(                                      \
      const Patches<Backend<Real, Exec>>&, const TetMesh&, const std::vector<FibreAxes>&,   \
      const std::vector<FibreAxes>&);                                                       \
  template Scalars<Backend<Real, Exec>> device_fibres(                                      \
      const NodalRows<Backend<Real, Exec>>&, const TetMesh&, const std::vector<FibreAxes>&, \
      const std::vector<FibreAxes>&);
PLICA_FOR_EACH_PRECISION(PLICA_INSTANTIATE)

}  // namespace plica
