// SPDX-License-Identifier: BSD-3-Clause
#include <plica/drivers/elastic/build_nodal_rows.hpp>
#include <plica/drivers/linear/cycle_product.hpp>
#include <plica/drivers/spaces/transfer_matrix.hpp>
#include <plica/kernels/elastic/kept_tangents.hpp>
#include <plica/kernels/linear/packed_rows.hpp>
#include <plica/kernels/linear/system_kernels.hpp>
#include <plica/kernels/vectors.hpp>

namespace plica {

template <class B>
CycleProduct<B>::CycleProduct(const LevelData<B>& level, std::string_view material,
                              const Blocks<B>& inverse_diagonal)
    : elasticity_(make_elasticity<F>(material, Element::nodal)),
      inverse_diagonal_(inverse_diagonal) {
  const int n = level.model.vertices;
  Model<F>& model = level_.model;
  model.vertices = n;
  model.rows = level.model.float_rows;
  model.shares = model.rows.shares;
  level_.ranks = level.float_ranks;
  model.mass = zeros<Scalars<F>>("plica::cycle.mass", n);
  model.damping.everywhere = static_cast<float>(level.model.damping.everywhere);
  model.damping.of_vertex =
      zeros<Scalars<F>>("plica::cycle.damping", level.model.damping.of_vertex.extent(0));
  level_.nodal = make_nodal_work<F>(model.rows);
  level_.nodal.gradient =
      zeros<Scalars<F>>("plica::cycle.gradient", static_cast<std::size_t>(9 * model.rows.slots()));
  level_.partial = zeros<Vectors<F>>("plica::cycle.partial", model.shares.rows);
  u_ = zeros<Vectors<F>>("plica::cycle.u", n);
  p_ = zeros<Vectors<B>>("plica::cycle.p", n),
  beside_ = zeros<Vectors<B>>("plica::cycle.beside", n);
}

template <class B>
void CycleProduct<B>::prepare(const Level<B>& level, const State<B>& state,
                              const ImplicitWeights& weights, bool projected) {
  const Exec& exec = level.exec();
  const auto convert_to = [&](const auto& from, const auto& to) {
    convert(exec, "plica::cycle_values", from, to);
  };
  if (!forces_) {  // masses and damping do not change
    convert_to(level.model.mass, level_.model.mass);
    convert_to(level.model.damping.of_vertex, level_.model.damping.of_vertex);
  }
  forces_ = &level, weights_ = weights, positive_ = projected;
  convert_to(state.u, u_);
  keep_gradients<F>(exec, level_, u_);
  if (!projected || !keeps_tangents(level_.model.rows)) return;
  if (level_.nodal.tangent.extent(0) == 0)
    level_.nodal.tangent =
        zeros<Scalars<F>>("plica::cycle.tangent",
                          symmetric_nine * static_cast<std::size_t>(level_.model.rows.slots()));
  elasticity_->keep_tangents(exec, level_, u_);
}

template <class B>
template <class To>
void CycleProduct<B>::apply(const Exec& exec, const Vectors<F>& p, const To& q) const {
  elasticity_->tangent(exec, level_, {}, p, weights_.b / weights_.a, positive_);
  const bool alone = !forces_->acts_beside_elements();
  if (!alone) {
    convert(exec, "plica::cycle_values", p, p_);
    fill(exec, beside_, typename B::Real(0));
    forces_->add_product_beside_elements(p_, weights_, beside_);
  }
  update_vertices<F>(
      exec, "plica::cycle_product", level_.model.vertices,
      SystemProduct<F, B, To>{level_.model, p, level_.partial, q, static_cast<float>(weights_.a),
                              static_cast<float>(weights_.b), alone ? Vectors<B>() : beside_});
}

#define PLICA_INSTANTIATE(Real, Exec)                                                              \
  template class CycleProduct<Backend<Real, Exec>>;                                                \
  template void CycleProduct<Backend<Real, Exec>>::apply(                                          \
      const Exec&, const Vectors<Backend<float, Exec>>&, const Vectors<Backend<float, Exec>>&)     \
      const;                                                                                       \
  template void CycleProduct<Backend<Real, Exec>>::apply(                                          \
      const Exec&, const Vectors<Backend<float, Exec>>&, const SlotVectors<Backend<float, Exec>>&) \
      const;
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
