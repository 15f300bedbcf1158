// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/surface.hpp>
#include <plica/kernels/vectors.hpp>

namespace plica {

/// A += W^T C W with the symmetric blocks C [points][6] of surface points and their weights W: a row of A per work item, its
/// points in order. Vertices of one tetrahedron are coupled in A already, unless their motion is given.
template <class B>
struct AddContact {
  using Real = typename B::Real;
  EmbeddedSurface<B> surface;
  Blocks<B> block;
  BlockMatrix<B> A;

  KOKKOS_INLINE_FUNCTION void operator()(int item) const {
    const int a = surface.vertex(item), first = A.first(a), last = A.first(a + 1);
    for (int s = surface.first(item); s < surface.first(item + 1); ++s) {
      const int p = surface.point(s);
      const SymMat3<Real> C = block_at<B>(block, p);
      for (int c = 0; c < 4; ++c) {
        int at = first;
        while (at < last && A.column(at) != surface.embedding.source(p, c)) ++at;
        if (at == last) continue;
        const Real w = surface.weight(s) * surface.embedding.weight(p, c);
        add_block<B>(A, at, w, C);
      }
    }
  }
};

}  // namespace plica
