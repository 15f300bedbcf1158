// SPDX-License-Identifier: BSD-3-Clause
#include <plica/drivers/solver/him/turning_axes.hpp>
#include <plica/drivers/solver/spaces/sparse_rows.hpp>
#include <plica/kernels/contact/where_touching.hpp>
#include <plica/kernels/him/coarse_axes.hpp>

namespace plica {

namespace {

constexpr int most_rounds = 6;
constexpr double round_tolerance = 1e-3, least_share = 1e-6;  // of the momenta that the force adds, of all of them

}  // namespace

template <class B>
TurningAxes<B>::TurningAxes(const TetMesh& coarsest, const AxesShape& shape, const RowMatrix& all)
    : vertices_(static_cast<int>(coarsest.vertices.size())),
      tets_(static_cast<int>(coarsest.tets.size())),
      blocks_(vertices_),
      open_("plica::axes.open", 1),
      sums_("plica::axes.sums", 3) {
  const RowMatrix spread = shape.restriction.transpose();
  axes_.restriction = sparse_rows<B>("axes.restriction", shape.restriction);
  axes_.spread = sparse_rows<B>("axes.spread", spread);
  axes_.smoothing = sparse_rows<B>("axes.smoothing", shape.smoothing);
  axes_.smoothing_of = sparse_rows<B>("axes.smoothing_of", RowMatrix(shape.smoothing.transpose()));
  axes_.response = sparse_rows<B>("axes.response", RowMatrix(RowMatrix(all.transpose()) * spread));
  const auto n = static_cast<std::size_t>(vertices_);
  for (Vectors<B>* one : {&share_, &momentum_, &axes_.displacement, &axes_.force})
    *one = Vectors<B>("plica::axes.vectors", n);
  for (Vectors<B>* one : {&axes_.gradient, &axes_.stiffness, &axes_.torque})
    *one = Vectors<B>("plica::axes.matrices", 3 * n);
  std::vector<std::array<Real, 3>> unit(3 * n);
  for (std::size_t k = 0; k < unit.size(); ++k) unit[k][k % 3] = 1;
  rotation_ = to_device<Vectors<B>>("axes.rotation", unit);

  std::vector<std::vector<int>> around(n);
  std::vector<std::array<Real, 10>> shapes(coarsest.tets.size());
  for (std::size_t e = 0; e < coarsest.tets.size(); ++e) {
    for (std::size_t k = 0; k < 10; ++k) shapes[e][k] = static_cast<Real>(shape.tets[e][k]);
    for (std::size_t c = 0; c < 4; ++c)
      around[static_cast<std::size_t>(coarsest.tets[e][c])].push_back(static_cast<int>(4 * e + c));
  }
  axes_.of_tet = Vectors<B>("plica::axes.matrices", 3 * coarsest.tets.size());
  std::vector<int> first{0}, places;
  for (const auto& own : around) {
    places.insert(places.end(), own.begin(), own.end());
    first.push_back(static_cast<int>(places.size()));
  }
  axes_.first = to_device<Indices<B>>("axes.first", first), axes_.place = to_device<Indices<B>>("axes.place", places);
  axes_.corner = to_device<decltype(axes_.corner)>("axes.corner", coarsest.tets);
  axes_.shape = to_device<decltype(axes_.shape)>("axes.shape", shapes);
}

template <class B>
void TurningAxes<B>::turn(const Exec& exec, const Vectors<B>& u, const Values& moved) const {
  update_vertices<B>(exec, "plica::axes_restrict", vertices_,
                     MultiplyRows<B>{axes_.restriction, u, axes_.displacement});
  update_vertices<B>(exec, "plica::axes_gradients", tets_, GradientsOfTets<B>{axes_});
  update_vertices<B>(exec, "plica::axes_gradients", vertices_, SumGradients<B>{axes_});
  reduce<B, 2>(exec, "plica::axes_turn", vertices_, TurnAxes<B>{axes_, rotation_}, blocks_, moved);
}

template <class B>
void TurningAxes<B>::push(const Exec& exec, const Vectors<B>& q, const Filter& filter, double weight, double t,
                          const Model<B>& model, const Vectors<B>& p) const {
  const auto h = static_cast<Real>(t);
  Kokkos::deep_copy(exec, open_, 1.0);
  update_vertices<B>(exec, "plica::axes_momentum", vertices_, WarmMomentum<B>{q, share_, momentum_});
  for (int round = 0; round < most_rounds; ++round) {
    const Scalars<B>& x = filter(momentum_, open_);
    where_touching<B>(exec, open_, "plica::axes_torque", vertices_,
                      TorqueOnAxes<B>{axes_, rotation_, momentum_, x, static_cast<Real>(weight)});
    where_touching<B>(exec, open_, "plica::axes_torque", vertices_, TorqueOnGradients<B>{axes_});
    where_touching<B>(exec, open_, "plica::axes_force", tets_, ForcesOfTets<B>{axes_});
    where_touching<B>(exec, open_, "plica::axes_force", vertices_, SumForces<B>{axes_});
    reduce<B, 3>(exec, "plica::axes_momentum", vertices_,
                 NextMomentum<B>{axes_.response, axes_.force, q, share_, momentum_, open_, h}, blocks_, sums_);
    update_vertices<B>(exec, "plica::axes_decide", 1, DecideToGoOn<B>{sums_, open_, round_tolerance, least_share});
  }
  update_vertices<B>(exec, "plica::axes_push", model.vertices,
                     PushByAxes<B>{axes_.spread, model.inverse_mass, axes_.force, p, h});
}

template <class B>
std::size_t TurningAxes<B>::bytes() const {
  std::size_t total =
      bytes_of_views(axes_.first, axes_.place, axes_.of_tet, axes_.corner, axes_.shape, axes_.displacement,
                     axes_.gradient, axes_.stiffness, axes_.torque, axes_.force, rotation_, share_, momentum_);
  for (const SparseRows<B>* one :
       {&axes_.restriction, &axes_.spread, &axes_.smoothing, &axes_.smoothing_of, &axes_.response})
    total += bytes_of_rows(*one);
  return total;
}

#define PLICA_INSTANTIATE(Real, Exec) template class TurningAxes<Backend<Real, Exec>>;
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
