// SPDX-License-Identifier: BSD-3-Clause
#include <plica/drivers/solver/linear/last_solutions.hpp>
#include <plica/drivers/solver/spaces/sparse_rows.hpp>
#include <plica/kernels/explicit/updates.hpp>

namespace plica {

template <class B>
LastSolutions<B>::LastSolutions(int vertices) {
  for (auto& w : space_.w) w = Vectors<B>("plica::last_solutions.w", vertices);
  for (auto& q : space_.q) q = Vectors<B>("plica::last_solutions.q", vertices);
  space_.products = Kokkos::View<double*, typename B::Memory>("plica::last_solutions.products", SolutionSpace<B>::sums);
}

template <class B>
void LastSolutions<B>::start(const Exec& exec, const StageSystem<B>& system, const BlockSums<B>& sums,
                             const Vectors<B>& r, const Vectors<B>& x) const {
  if (!any()) return;
  const int n = system.rows();
  constexpr double least = 1e4 * Kokkos::Experimental::epsilon_v<typename B::Real>;
  system.products(exec, space_);
  reduce<B, SolutionSpace<B>::sums>(exec, "plica::space_sums", n, SpaceSums<B>{space_, r}, sums, space_.products);
  update_vertices<B>(exec, "plica::space_weights", 1, SpaceWeights<B>{space_.products, least});
  update_vertices<B>(exec, "plica::space_guess", n, SpaceGuess<B>{space_, r, x});
}

template <class B>
void LastSolutions<B>::add(const Exec& exec, const Vectors<B>& x) {
  Kokkos::deep_copy(exec, space_.w[count_++ % SolutionSpace<B>::size], x);
}

template <class B>
std::size_t LastSolutions<B>::bytes() const {
  return bytes_of_views(space_.products) +
         SolutionSpace<B>::size * (bytes_of_views(space_.w[0]) + bytes_of_views(space_.q[0]));
}

template <class B>
void LastSolutions<B>::persist(StateArchive<B>& archive) {
  archive.number(count_);
  for (const auto& w : space_.w) archive.field("a last solution", w);
}

#define PLICA_INSTANTIATE(Real, Exec) template class LastSolutions<Backend<Real, Exec>>;
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
