// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/kernels/vectors.hpp>
#include <span>
#include <vector>

namespace plica {

namespace {

template <class B>
struct SumBlocks {
  using Member = typename Kokkos::TeamPolicy<typename B::Exec>::member_type;
  TotalOfBlocks<B> blocks;
  int sums;  // number of results that are sums; those after them are maxima
  Doubles<B> result;

  KOKKOS_INLINE_FUNCTION void operator()(int k) const {
    result(k) = k < sums ? blocks.sum(k) : blocks.most(k);
  }
  KOKKOS_INLINE_FUNCTION void operator()(const Member& team) const {
    const int k = league_rank(team);
    const double total = k < sums ? blocks.sum(team, k) : blocks.most(team, k);
    Kokkos::single(Kokkos::PerTeam(team), [&]() { result(k) = total; });
  }
};

template <class B>
struct Add {
  using Real = typename B::Real;
  Real a;
  const Real* x;
  Real* y;
  KOKKOS_INLINE_FUNCTION void operator()(std::size_t i) const { y[i] += a * x[i]; }
};

template <class B>
struct Combine {
  using Real = typename B::Real;
  Real a, b;
  const Real *x, *y;
  Real* out;
  KOKKOS_INLINE_FUNCTION void operator()(std::size_t i) const { out[i] = a * x[i] + b * y[i]; }
};

template <class From, class To>
struct Convert {
  const From* from;
  To* to;
  KOKKOS_INLINE_FUNCTION void operator()(std::size_t i) const { to[i] = static_cast<To>(from[i]); }
};

template <class B>
struct CombineFree {
  using Real = typename B::Real;
  Scalars<B> inverse_mass;
  Real a, b;
  Vectors<B> x, y, out;
  KOKKOS_INLINE_FUNCTION void operator()(int i) const {
    if (inverse_mass(i) > 0)
      for (int k = 0; k < 3; ++k) out(i, k) = a * x(i, k) + b * y(i, k);
  }
};

template <class B>
struct Weigh {
  using Real = typename B::Real;
  Scalars<B> mass, inverse_mass;
  Real a, b;
  Vectors<B> x, y, out;
  KOKKOS_INLINE_FUNCTION void operator()(int i) const {
    const Real m = a * mass(i);
    for (int k = 0; k < 3; ++k)
      out(i, k) = inverse_mass(i) > 0 ? m * x(i, k) + b * y(i, k) : Real(0);
  }
};

template <class B>
struct First {
  Vectors<B> x;
  KOKKOS_INLINE_FUNCTION Sums<1> operator()(int i) const {
    return {{static_cast<double>(x(i, 0))}};
  }
};

template <class B>
struct FillFromHash {
  Scalars<B> inverse_mass;
  Vectors<B> x;
  Indices<B> number;
  KOKKOS_INLINE_FUNCTION Sums<1> operator()(int a) const {
    double sum = 0;
    for (int k = 0; k < 3; ++k) {
      const int v = number.extent(0) > 0 ? number(a) : a;
      const double value = inverse_mass(a) > 0 ? hashed(v, k) : 0.0;
      x(a, k) = static_cast<typename B::Real>(value);
      sum += value * value;
    }
    return {{sum}};
  }
};

template <class Exec, class Work>
void each(const Exec& exec, const char* label, std::size_t count, const Work& work) {
  using Policy = Kokkos::RangePolicy<Exec, Kokkos::IndexType<std::size_t>>;
  launch(label, Policy(exec, 0, count), work);
}

template <class B>
int length_of(const Vectors<B>& x) {
  return static_cast<int>(x.extent(0));
}

}  // namespace

template <class B>
void sum_blocks(const typename B::Exec& exec, const char* label, int count, int n, int maxima,
                const typename BlockSums<B>::View& blocks, const Doubles<B>& result) {
  launch_blocks<B>(exec, label, n, SumBlocks<B>{{count, blocks}, n - maxima, result});
}

template <class B>
void sum_over_ranks(const typename B::Exec& exec, int count, int n, int maxima,
                    const BlockSums<B>& blocks, const Doubles<B>& result) {
  constexpr int widest = BlockSums<B>::widest;
  launch_gathered<typename B::Exec>();
  std::vector<double> sums(static_cast<std::size_t>(count * widest));
  fields::download(exec, sums.data(), blocks.view().data(), sums.size() * sizeof(double));
  const auto at = [&](int b, int k) { return sums[static_cast<std::size_t>(b * widest + k)]; };
  std::vector<double> total(static_cast<std::size_t>(n), 0.0);
  std::vector<std::int64_t> integers(static_cast<std::size_t>((n - maxima) * ExactSum::words));
  for (int k = 0; k < n - maxima; ++k) {
    ExactSum sum;
    for (int b = 0; b < count; ++b) sum.add(at(b, k));
    sum.store(integers.data() + k * ExactSum::words);
  }
  if (n > maxima) blocks.ranks()->sum(integers);
  for (int k = 0; k < n - maxima; ++k)
    total[static_cast<std::size_t>(k)] =
        ExactSum::load(integers.data() + k * ExactSum::words).take();
  const std::span most(total.data() + n - maxima, static_cast<std::size_t>(maxima));
  for (int k = n - maxima; k < n; ++k)
    for (int b = 0; b < count; ++b)
      total[static_cast<std::size_t>(k)] = std::max(total[static_cast<std::size_t>(k)], at(b, k));
  if (maxima > 0) blocks.ranks()->most(most);
  fields::upload<typename B::Memory>(result.data(), total.data(), total.size() * sizeof(double));
}

namespace vectors {

template <class B>
void add(const typename B::Exec& exec, const char* label, std::size_t count, typename B::Real a,
         const typename B::Real* x, typename B::Real* y) {
  each(exec, label, count, Add<B>{a, x, y});
}

template <class B>
void combine(const typename B::Exec& exec, const char* label, std::size_t count, typename B::Real a,
             const typename B::Real* x, typename B::Real b, const typename B::Real* y,
             typename B::Real* out) {
  each(exec, label, count, Combine<B>{a, b, x, y, out});
}

template <class Exec, class From, class To>
void convert(const Exec& exec, const char* label, std::size_t count, const From* from, To* to) {
  each(exec, label, count, Convert<From, To>{from, to});
}

}  // namespace vectors

template <class B>
void combine_free(const typename B::Exec& exec, const char* label, const Scalars<B>& inverse_mass,
                  typename B::Real a, const Vectors<B>& x, typename B::Real b, const Vectors<B>& y,
                  const Vectors<B>& out) {
  update_vertices<B>(exec, label, length_of<B>(out), CombineFree<B>{inverse_mass, a, b, x, y, out});
}

template <class B>
void weigh(const typename B::Exec& exec, const char* label, const Model<B>& model,
           typename B::Real a, const Vectors<B>& x, typename B::Real b, const Vectors<B>& y,
           const Vectors<B>& out) {
  update_vertices<B>(exec, label, length_of<B>(out),
                     Weigh<B>{model.mass, model.inverse_mass, a, b, x, y, out});
}

template <class B>
void dot(const typename B::Exec& exec, const char* label, const Vectors<B>& x, const Vectors<B>& y,
         const BlockSums<B>& blocks, const Doubles<B>& result) {
  reduce<B, 1>(exec, label, length_of<B>(x), Dot<B>{x, y}, blocks, result);
}

template <class B>
void sum_first(const typename B::Exec& exec, const char* label, const Vectors<B>& x,
               const BlockSums<B>& blocks, const Doubles<B>& result) {
  reduce<B, 1>(exec, label, length_of<B>(x), First<B>{x}, blocks, result);
}

template <class B>
void fill_from_hash(const typename B::Exec& exec, const char* label, const Scalars<B>& inverse_mass,
                    const Vectors<B>& x, const BlockSums<B>& blocks, const Doubles<B>& result,
                    const std::optional<Items>& owned, const Indices<B>& number) {
  reduce<B, 1>(exec, label, owned.value_or(length_of<B>(x)),
               FillFromHash<B>{inverse_mass, x, number}, blocks, result);
}

#define PLICA_INSTANTIATE(Real, Exec)                                                              \
  template void sum_blocks<Backend<Real, Exec>>(const Exec&, const char*, int, int, int,           \
                                                const BlockSums<Backend<Real, Exec>>::View&,       \
                                                const Doubles<Backend<Real, Exec>>&);              \
  template void sum_over_ranks<Backend<Real, Exec>>(const Exec&, int, int, int,                    \
                                                    const BlockSums<Backend<Real, Exec>>&,         \
                                                    const Doubles<Backend<Real, Exec>>&);          \
  template void vectors::add<Backend<Real, Exec>>(const Exec&, const char*, std::size_t, Real,     \
                                                  const Real*, Real*);                             \
  template void vectors::combine<Backend<Real, Exec>>(const Exec&, const char*, std::size_t, Real, \
                                                      const Real*, Real, const Real*, Real*);      \
  template void vectors::convert<Exec, Real, float>(const Exec&, const char*, std::size_t,         \
                                                    const Real*, float*);                          \
  template void vectors::convert<Exec, Real, double>(const Exec&, const char*, std::size_t,        \
                                                     const Real*, double*);                        \
  template void combine_free<Backend<Real, Exec>>(                                                 \
      const Exec&, const char*, const Scalars<Backend<Real, Exec>>&, Real,                         \
      const Vectors<Backend<Real, Exec>>&, Real, const Vectors<Backend<Real, Exec>>&,              \
      const Vectors<Backend<Real, Exec>>&);                                                        \
  template void weigh<Backend<Real, Exec>>(                                                        \
      const Exec&, const char*, const Model<Backend<Real, Exec>>&, Real,                           \
      const Vectors<Backend<Real, Exec>>&, Real, const Vectors<Backend<Real, Exec>>&,              \
      const Vectors<Backend<Real, Exec>>&);                                                        \
  template void dot<Backend<Real, Exec>>(                                                          \
      const Exec&, const char*, const Vectors<Backend<Real, Exec>>&,                               \
      const Vectors<Backend<Real, Exec>>&, const BlockSums<Backend<Real, Exec>>&,                  \
      const Doubles<Backend<Real, Exec>>&);                                                        \
  template void sum_first<Backend<Real, Exec>>(                                                    \
      const Exec&, const char*, const Vectors<Backend<Real, Exec>>&,                               \
      const BlockSums<Backend<Real, Exec>>&, const Doubles<Backend<Real, Exec>>&);                 \
  template void fill_from_hash<Backend<Real, Exec>>(                                               \
      const Exec&, const char*, const Scalars<Backend<Real, Exec>>&,                               \
      const Vectors<Backend<Real, Exec>>&, const BlockSums<Backend<Real, Exec>>&,                  \
      const Doubles<Backend<Real, Exec>>&, const std::optional<Items>&,                            \
      const Indices<Backend<Real, Exec>>&);
PLICA_FOR_EACH_PRECISION(PLICA_INSTANTIATE)

}  // namespace plica
