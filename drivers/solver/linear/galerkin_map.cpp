// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/drivers/solver/linear/multigrid.hpp>
#include <plica/drivers/solver/spaces/row_ranges.hpp>

namespace plica {

namespace {

/// One term of a coarse block of some row: weight times a block of A.
struct Term {
  int column, fine;
  double weight;
};

std::vector<Term> terms_of_row(const HostPattern& A, const RowMatrix& P, const RowMatrix& Pt, int row) {
  std::vector<Term> terms;
  for (RowMatrix::InnerIterator i(Pt, row); i; ++i)
    for (int s = A.first[index_of(static_cast<int>(i.col()))]; s < A.first[index_of(static_cast<int>(i.col()) + 1)];
         ++s)
      for (RowMatrix::InnerIterator j(P, A.column[index_of(s)]); j; ++j)
        if (j.col() >= row) terms.push_back({static_cast<int>(j.col()), s, i.value() * j.value()});
  std::sort(terms.begin(), terms.end(),
            [](const Term& a, const Term& b) { return std::pair(a.column, a.fine) < std::pair(b.column, b.fine); });
  return terms;
}

HostPattern both_halves(const std::vector<std::vector<int>>& upper) {
  std::vector<std::vector<int>> rows(upper.size());
  for (std::size_t a = 0; a < upper.size(); ++a)
    for (const int b : upper[a]) {
      if (static_cast<int>(a) != b) rows[index_of(b)].push_back(static_cast<int>(a));
      rows[a].push_back(b);
    }
  HostPattern pattern;
  for (auto& row : rows) {
    std::sort(row.begin(), row.end());
    pattern.column.insert(pattern.column.end(), row.begin(), row.end());
    pattern.first.push_back(static_cast<int>(pattern.column.size()));
  }
  return pattern;
}

int place_of(const HostPattern& A, int a, int b) {
  const auto first = A.column.begin() + A.first[index_of(a)], last = A.column.begin() + A.first[index_of(a + 1)];
  return static_cast<int>(std::lower_bound(first, last, b) - A.column.begin());
}

}  // namespace

template <class B>
HostPattern host_pattern(const BlockMatrix<B>& A) {
  HostPattern pattern;
  const auto first = on_host(A.first), column = on_host(A.column);
  pattern.first.assign(first.data(), first.data() + first.extent(0));
  pattern.column.assign(column.data(), column.data() + column.extent(0));
  return pattern;
}

template <class B>
BlockMatrix<B> block_matrix(const std::string& name, const HostPattern& pattern) {
  std::vector<int> diagonal;
  for (int a = 0; a < pattern.rows(); ++a) diagonal.push_back(place_of(pattern, a, a));
  return {pattern.rows(), to_device<Indices<B>>(name + ".first", pattern.first),
          to_device<Indices<B>>(name + ".column", pattern.column), to_device<Indices<B>>(name + ".diagonal", diagonal),
          zeros<Blocks9<B>>("plica::" + name + ".value", pattern.column.size() + 1)};
}

template <class B>
CoarseMatrix<B> coarse_matrix(const HostPattern& A, const RowMatrix& P) {
  const RowMatrix Pt = P.transpose();
  std::vector<std::vector<int>> upper(static_cast<std::size_t>(P.cols()));
  std::vector<int> first{0}, fine;
  std::vector<typename B::Real> weight;
  for (int a = 0; a < static_cast<int>(P.cols()); ++a) {
    std::vector<int>& row = upper[index_of(a)];
    row.push_back(a);
    for (const Term& term : terms_of_row(A, P, Pt, a)) {
      if (term.column != row.back()) {
        row.push_back(term.column);
        first.push_back(static_cast<int>(fine.size()));
      }
      fine.push_back(term.fine);
      weight.push_back(static_cast<typename B::Real>(term.weight));
    }
    first.push_back(static_cast<int>(fine.size()));
  }
  CoarseMatrix<B> made;
  made.pattern = both_halves(upper);
  made.matrix = block_matrix<B>("multigrid", made.pattern);
  std::vector<int> to_upper, to_lower;
  for (int a = 0; a < static_cast<int>(upper.size()); ++a)
    for (const int b : upper[index_of(a)])
      to_upper.push_back(place_of(made.pattern, a, b)), to_lower.push_back(place_of(made.pattern, b, a));
  made.map = {to_device<Indices<B>>("galerkin.first", first), to_device<Indices<B>>("galerkin.fine", fine),
              to_device<Scalars<B>>("galerkin.weight", weight), to_device<Indices<B>>("galerkin.upper", to_upper),
              to_device<Indices<B>>("galerkin.lower", to_lower)};
  return made;
}

#define PLICA_INSTANTIATE(Real, Exec)                                                                                  \
  template HostPattern host_pattern<Backend<Real, Exec>>(const BlockMatrix<Backend<Real, Exec>>&);                     \
  template BlockMatrix<Backend<Real, Exec>> block_matrix<Backend<Real, Exec>>(const std::string&, const HostPattern&); \
  template CoarseMatrix<Backend<Real, Exec>> coarse_matrix<Backend<Real, Exec>>(const HostPattern&, const RowMatrix&);
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
