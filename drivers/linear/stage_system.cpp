// SPDX-License-Identifier: BSD-3-Clause
#include <plica/drivers/linear/stage_system.hpp>
#include <plica/drivers/spaces/transfer_matrix.hpp>
#include <plica/kernels/linear/hold_system.hpp>
#include <plica/kernels/linear/vertex_blocks.hpp>
#include <plica/kernels/loads/boundary_conditions.hpp>
#include <plica/kernels/vectors.hpp>

namespace plica {

template <class B>
StageSystem<B>::StageSystem(const LevelData<B>& level, bool assembled, bool kept)
    : nodal_(is_nodal(level)),
      assembled_(assembled),
      kept_(kept),
      inverse_diagonal_(zeros<Blocks<B>>("plica::linear.inverse_diagonal", level.model.vertices)),
      level_(&level) {
  if (by_matrix()) pattern();
}

template <class B>
const BlockMatrix<B>& StageSystem<B>::pattern() {
  if (pattern_.matrix.rows == 0) {
    pattern_ = block_pattern<B>(model_of_matrix<B>(*level_), items());
    shares_ = zeros<Blocks9<B>>("plica::linear.shares", pattern_.pairs.shares);
    if (nodal_ && !has_products())
      blocks_of_matrix_ =
          zeros<Blocks<B>>("plica::linear.blocks_of_matrix", inverse_diagonal_.extent(0));
    if (composes())
      composed_ = coarse_matrix<B>(host_pattern(pattern_.matrix), motion_of_free<B>(level_->model));
  }
  return composes() ? composed_.matrix : pattern_.matrix;
}

template <class B>
void StageSystem<B>::prepare(const Level<B>& level, const State<B>& state,
                             const ImplicitWeights& weights, bool projected) {
  const Exec& exec = level.exec();
  level_ = &level, forces_ = &level, state_ = state, weights_ = weights, positive_ = projected,
  ready_ = false;
  if (by_matrix()) return invert_blocks_of_matrix(exec, inverse_diagonal_);
  if (cycle_product_) cycle_product_->prepare(level, state_, weights, projected);
  level.diagonal(state, weights, projected, inverse_diagonal_);
  add_contact_blocks(exec, false, inverse_diagonal_);
  invert_blocks(exec, inverse_diagonal_);
}

template <class B>
void StageSystem<B>::add_contact_blocks(const Exec& exec, bool beside,
                                        const Blocks<B>& blocks) const {
  if (forces_->contact()) forces_->response().add_diagonal(exec, *level_, beside, blocks);
}

template <class B>
InvertBlocks<B> StageSystem<B>::inverting(const Blocks<B>& blocks) const {
  return {level_->model, blocks, static_cast<typename B::Real>(weights_.b)};
}

template <class B>
void StageSystem<B>::hold(const Exec& exec, const Vectors<B>& x) const {
  hold_sliding(exec, *level_, x);
}

template <class B>
void StageSystem<B>::invert_blocks(const Exec& exec, const Blocks<B>& blocks) const {
  if (level_->sliding.count > 0)
    update_vertices<B>(exec, "plica::hold_blocks", level_->sliding.count,
                       HoldBlocks<B>{level_->sliding, blocks});
  update_vertices<B>(exec, "plica::invert_blocks", rows(), inverting(blocks));
}

template <class B>
void StageSystem<B>::invert_blocks_of_matrix(const Exec& exec, const Blocks<B>& blocks) {
  update_vertices<B>(exec, "plica::take_diagonal", rows(), TakeDiagonal<B>{matrix(exec), blocks});
  add_contact_blocks(exec, true, blocks);
  invert_blocks(exec, blocks);
}

template <class B>
void StageSystem<B>::fit(const Exec& exec, Preconditioner<B>& preconditioner) {
  const BlockMatrix<B>& A = matrix(exec);
  if (!nodal_ || has_products()) return preconditioner.fit(exec, A, inverse_diagonal_);
  invert_blocks_of_matrix(exec, blocks_of_matrix_);
  preconditioner.fit(exec, A, blocks_of_matrix_);
}

template <class B>
const BlockMatrix<B>& StageSystem<B>::matrix(const Exec& exec) {
  const BlockMatrix<B>& A = pattern();
  if (!ready_) {
    forces_->assemble(state_, weights_, positive_, pattern_.pairs, shares_, pattern_.matrix);
    if (composes()) galerkin_product<B>(exec, composed_.map, pattern_.matrix, composed_.matrix);
    if (level_->sliding.count > 0)
      update_vertices<B>(exec, "plica::hold_matrix", rows(), HoldMatrix<B>{level_->sliding, A});
  }
  ready_ = true;
  return A;
}

template <class B>
const BlockMatrix<B>& StageSystem<B>::stored() const {
  return composes() ? composed_.matrix : pattern_.matrix;
}

template <class B>
const CycleProduct<B>* StageSystem<B>::cycle_product(std::string_view material) {
  if (has_products() && !cycle_product_)
    cycle_product_ = std::make_unique<CycleProduct<B>>(*level_, material, inverse_diagonal_);
  return cycle_product_.get();
}

template <class B>
void StageSystem<B>::product(const Exec& exec, const Vectors<B>& p, const Vectors<B>& q) const {
  if (!nodal_) share_vertices<B>(exec, *level_, p);  // products of nodal elements do it themselves
  if (by_matrix()) {
    update_vertices<B>(exec, "plica::block_product", rows(), BlockProduct<B>{stored(), p, q});
    if (!by_matrix_alone()) follow_masters(exec, level_->model, p);
    forces_->add_product_beside_matrix(state_, p, weights_, positive_, q);
  } else {
    forces_->product(state_, p, weights_, positive_, q);
  }
  hold(exec, q);
}

template <class B>
void StageSystem<B>::product(const Exec& exec, const Vectors<B>& p, const Vectors<B>& q,
                             const BlockSums<B>& sums, const Doubles<B>& curvature,
                             const CgStep<B>& then) const {
  if (by_matrix_alone()) {
    share_vertices<B>(exec, *level_, p);
    return reduce<B, 1>(exec, "plica::block_product", items(), BlockProductDot<B>{stored(), p, q},
                        sums, curvature, then);
  }
  product(exec, p, q);
  reduce<B, 1>(exec, "plica::curvature", items(), Dot<B>{p, q}, sums, curvature, then);
}

template <class B>
void StageSystem<B>::products(const Exec& exec, const SolutionSpace<B>& space) const {
  if (by_matrix_alone())
    update_vertices<B>(exec, "plica::space_products", rows(), SpaceProducts<B>{stored(), space});
  else
    for (int i = 0; i < SolutionSpace<B>::size; ++i) product(exec, space.w[i], space.q[i]);
}

#define PLICA_INSTANTIATE(Real, Exec) template class StageSystem<Backend<Real, Exec>>;
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
