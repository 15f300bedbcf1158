// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <plica/drivers/contact/build_surface.hpp>
#include <plica/kernels/elastic/elastic_force.hpp>
#include <plica/kernels/transfer/transfer.hpp>

#include "support/backends.hpp"
#include "support/plain_elements.hpp"
#include "support/three_constants.hpp"
#include "support/tolerance.hpp"

// The patch kernel and the transfers against sums written out element by element in double: with
// few parts of the library, so that they can be compiled for any width of vectors.
namespace {

using namespace plica;
using namespace plica::test;

template <class B>
class PatchKernelOn : public testing::Test {};
TYPED_TEST_SUITE(PatchKernelOn, EachBackend);

template <class B, class M>
void expect_its_force(const Disordered<B>& on) {
  expect_the_sum<B, M>(on, nullptr, [&](const Patches<B>& patches) {
    return ElasticForce<B, M, false>{{on.u_here}, patches.constants, {}, 0};
  });
}

TYPED_TEST(PatchKernelOn, IsTheSumOverTheElements) {
  const Disordered<TypeParam> on;
  Materials::for_each([&](auto material) { expect_its_force<TypeParam, decltype(material)>(on); });
}

TYPED_TEST(PatchKernelOn, TakesAMaterialOfThreeConstants) {
  expect_its_force<TypeParam, ThreeConstants>({});
}

// Each region's patches have its constants
TYPED_TEST(PatchKernelOn, KnowsTheConstantsOfEveryRegion) {
  using B = TypeParam;
  TetMesh mesh = irregular_box();
  mesh.region_names = {"left", "right"};
  for (std::size_t e = 0; e < mesh.tets.size(); ++e) mesh.region.push_back(e % 3 == 0 ? 1 : 0);
  const Patches<B> patches = build_patches<B>(mesh, {{1, 2, 3, 4}, {5, 6, 7, 8}});
  const auto host_of = [](const auto& view) {
    return Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), view);
  };
  const auto constants = host_of(patches.constants);
  const auto element = host_of(patches.element), first = host_of(patches.first_pack);
  ASSERT_EQ(constants.extent(0), static_cast<std::size_t>(4 * patches.count));
  for (int p = 0; p < patches.count; ++p) {
    const auto c = load_constants<ThreeConstants, double>(constants, p);
    const int region = mesh.region[static_cast<std::size_t>(element(first(p) * B::lanes))];
    EXPECT_EQ(c.c1, 1 + 4 * region);
    EXPECT_EQ(c.c2, 2 + 4 * region);
    EXPECT_EQ(c.bulk, 3 + 4 * region);
    EXPECT_EQ(c.rest, 4 + 4 * region);
  }
}

// Every vertex of a patch once, by the number of its elements; every corner of its elements once,
// and nothing else but `nothing`
TYPED_TEST(PatchKernelOn, SumsUpByLength) {
  using P = Patches<TypeParam>;
  const P patches = build_patches<TypeParam>(irregular_box(), {as_list(soft)});
  const auto first_vertex = on_host(patches.first_vertex), first_pack = on_host(patches.first_pack);
  const auto first_sum = on_host(patches.first_sum), first_slot = on_host(patches.first_slot);
  const auto summed = on_host(patches.summed), slot = on_host(patches.slot);
  const auto corner = on_host(patches.corner);
  const auto element = on_host(patches.element);
  for (int p = 0; p < patches.count; ++p) {
    const int vertices = first_vertex(p + 1) - first_vertex(p);
    ASSERT_EQ(first_sum(p + 1) - first_sum(p), (vertices + P::at_once - 1) / P::at_once);
    std::vector<std::vector<int>> slots(static_cast<std::size_t>(vertices)), expected = slots;
    std::vector<std::size_t> lengths;
    for (int i = 0; i < vertices; ++i) {
      auto& of = slots[summed(first_vertex(p) + i)];
      EXPECT_TRUE(of.empty()) << p << " " << i;
      const int sum = first_sum(p) + i / P::at_once;
      for (int s = first_slot(sum) + i % P::at_once; s < first_slot(sum + 1); s += P::at_once)
        if (slot(s) != P::nothing) of.push_back(slot(s));
      lengths.push_back(of.size());
    }
    EXPECT_TRUE(std::ranges::is_sorted(lengths)) << p;
    EXPECT_LT(lengths.front(), lengths.back()) << p;
    for (int q = first_pack(p); q < first_pack(p + 1); ++q)
      for (int l = 0; l < P::lanes; ++l)
        for (int c = 0; c < 4 && element(q * P::lanes + l) >= 0; ++c)
          expected[corner(q, c, l)].push_back(((q - first_pack(p)) * 4 + c) * 3 * P::lanes + l);
    for (auto& of : expected) std::ranges::sort(of);
    for (auto& of : slots) std::ranges::sort(of);
    EXPECT_EQ(slots, expected) << p;
  }
}

TYPED_TEST(PatchKernelOn, WatchesEveryLaneForInversion) {
  using B = TypeParam;
  const TetMesh mesh = irregular_box();
  const Patches<B> patches = build_patches<B>(mesh, {as_list(soft)});
  const auto element = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), patches.element);
  for (const int turned : {0, 7, 100, static_cast<int>(mesh.tets.size()) - 1}) {
    Field u(mesh.vertices.size(), Point::Zero());
    const auto& t = mesh.tets[static_cast<std::size_t>(turned)];
    const auto x = [&](std::size_t c) { return mesh.vertices[static_cast<std::size_t>(t[c])]; };
    // through the opposite face
    u[static_cast<std::size_t>(t[0])] = 2.2 * ((x(1) + x(2) + x(3)) / 3 - x(0));
    const auto flags = make_element_flags<B>(patches.count);
    through_patches(mesh, patches,
                    ElasticForce<B, NeoHookean, true>{{device<B>(u)}, patches.constants, flags, 1});
    const auto found = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), flags.evaluation);
    const auto word = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), flags.word);
    std::vector<int> inverted;
    for (int p = 0; p < patches.count; ++p)
      if (found(p) == 1) {
        EXPECT_LE(flags.J(word(p)), 0);
        inverted.push_back(element(flags.slot(word(p))));
      }
    EXPECT_FALSE(inverted.empty()) << turned;
    for (const int e : inverted) {  // it, or another one of the vertex that moved
      const auto& other = mesh.tets[static_cast<std::size_t>(e)];
      EXPECT_NE(std::find(other.begin(), other.end(), t[0]), other.end()) << e;
    }
  }
}

TYPED_TEST(PatchKernelOn, TransfersAreWeightedSums) {
  using B = TypeParam;
  Embedding embedding;
  embedding.vertices = {{0, 1, 2, 3}, {4, 2, 1, 0}, {3, 3, 4, 1}};
  embedding.weights = {{0.1, 0.2, 0.3, 0.4}, {1, 0, 0, 0}, {0.25, 0.25, 0.75, -0.25}};
  const auto transfer = build_transfer<B>("test", embedding, {});
  const auto source = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), transfer.source);
  for (int row = 0; row < 3; ++row)
    for (int c = 0; c < 3; ++c)
      EXPECT_LE(source(row, c), source(row, 3)) << "what is last is read by itself";
  const Field u = disorder(5, 1, 1), v = disorder(5, 1, 2);
  const State<B> from(device<B>(u), device<B>(v)), to("test.to", 3);
  map_fields<B, MapState>({}, "test", transfer, from, {}, {}, to, {});
  const auto sums = [&](const Field& x) {
    Field y(3, Point::Zero());
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t c = 0; c < 4; ++c)
        y[i] += embedding.weights[i][c] * x[static_cast<std::size_t>(embedding.vertices[i][c])];
    return y;
  };
  EXPECT_LE(largest_difference(host<B>(to.u), sums(u)), round_off<typename B::Real>(8));
  EXPECT_LE(largest_difference(host<B>(to.v), sums(v)), round_off<typename B::Real>(8));
}

}  // namespace
