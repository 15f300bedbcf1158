// SPDX-License-Identifier: BSD-3-Clause
#include "any_order.hpp"

#include <plica/drivers/elastic/build_nodal_rows.hpp>
#include <plica/drivers/linear/block_pattern.hpp>
#include <plica/kernels/elastic/elastic_blocks.hpp>
#include <plica/kernels/elastic/elastic_force.hpp>
#include <plica/kernels/elastic/elastic_stress.hpp>
#include <plica/kernels/elastic/elastic_tangent.hpp>
#include <plica/kernels/elastic/nodal_elements.hpp>
#include <plica/kernels/elastic/record_stress.hpp>

#include "support/plain_elements.hpp"

// What teams do with a patch, and what threads do with the rows of a slice: every number has its
// place, so that the size of the teams must not matter either.
namespace {

using namespace plica;
using namespace plica::test;
using Material = NeoHookean;

/// A box of a dozen patches, of linear and of nodal elements, at a random state.
template <class B>
struct Body {
  TetMesh mesh = box_mesh({Point::Zero(), Point(0.1, 0.1, 0.1)}, {8, 8, 8});
  std::size_t n = mesh.vertices.size();
  Vectors<B> v = device<B>(disorder(n, 0.001, 2)), f{"test.f", n};
  State<B> state{device<B>(disorder(n, 0.001, 1)), v};
  LevelData<B> level;
  Model<B>& model = level.model;

  Body() {
    model.vertices = static_cast<int>(n);
    model.patches = build_patches<B>(mesh, {as_list(soft)}, {1e-3});
    model.shares = model.patches.shares;
    model.mass = model.inverse_mass = ones(n);
    level.partial = Vectors<B>("test.partial", static_cast<std::size_t>(model.shares.rows));
  }
  void make_nodal(bool smoothed) {
    NodalConstants constants{{as_list(soft)}, {1e3}, {}, {1e-3}};
    if (smoothed) constants.bulk_excess = {1e4};
    model.rows = build_nodal_rows<B>(mesh, constants);
    model.shares = model.rows.shares;
    level.nodal = make_nodal_work<B>(model.rows);
    level.partial = Vectors<B>("test.partial", static_cast<std::size_t>(model.shares.rows));
  }
  std::vector<double> gathered() const {
    gather_forces<B>({}, model, level.partial, {}, f);
    return numbers(f);
  }
  static Scalars<B> ones(std::size_t count) {
    return to_device<Scalars<B>>("test.ones", std::vector<typename B::Real>(count, 1));
  }
};

template <class B>
class Teams : public testing::Test {};
TYPED_TEST_SUITE(Teams, EachBackend);

TYPED_TEST(Teams, ForceAndTangentOfPatches) {
  using B = TypeParam;
  Body<B> body;
  ASSERT_GT(body.model.patches.count, 8);
  const auto force = [&] {
    elastic_force<B, Material>({}, body.model.patches, body.state, body.level.flags, 1,
                               body.level.partial);
    return body.gathered();
  };
  const auto tangent = [&] {
    elastic_tangent<B, Material>({}, body.model.patches, body.state.u, body.v, 100,
                                 body.level.partial);
    return body.gathered();
  };
  expect_any_order(force), expect_any_order(tangent);
  body.level.flags = make_element_flags<B>(body.model.patches.count);
  expect_any_order(force);
  body.model.patches.damping = {};
  expect_any_order(force), expect_any_order(tangent);
}

TYPED_TEST(Teams, BlocksOfPatches) {
  using B = TypeParam;
  const Body<B> body;
  const auto [A, pairs] = block_pattern<B>(body.model, body.model.vertices);
  const Blocks9<B> shares("test.shares", static_cast<std::size_t>(pairs.shares));
  const auto work = [&, &A = A, &pairs = pairs] {
    elastic_blocks<B, Material, Material::Tangent>({}, body.model, pairs, body.state.u,
                                                   {1e-4, 1e-2}, shares, A);
    return numbers(A.value);
  };
  expect_any_order(work);
}

TYPED_TEST(Teams, StressAndWhatIsRememberedOfIt) {
  using B = TypeParam;
  Body<B> body;
  const Patches<B>& patches = body.model.patches;
  const auto slots = static_cast<std::size_t>(patches.packs * B::lanes);
  body.level.stress = {1, Indices<B>("test.region", slots), Body<B>::ones(2),
                       Scalars<B>("test.memory", 12 * slots), Scalars<B>()};
  expect_any_order([&] {
    fill(typename B::Exec(), body.level.stress.memory, 0);
    remember_elements<B, Material>({}, body.level, body.state.u, patches.constants);
    return numbers(body.level.stress.memory);
  });
  const Scalars<B> equivalent("test.equivalent", body.mesh.tets.size()),
      ratio("test.ratio", body.mesh.tets.size());
  expect_any_order([&] {
    elastic_stress<B, Material>({}, patches, body.state.u, {equivalent, ratio}, {});
    return numbers(equivalent);
  });
}

TYPED_TEST(Teams, RowsOfNodalElements) {
  using B = TypeParam;
  Body<B> body;
  for (const bool smoothed : {false, true}) {
    body.make_nodal(smoothed);
    expect_any_order([&] {
      nodal_force<B, Material>({}, body.level, body.state, 1);
      return body.gathered();
    });
    for (const double over : {0.0, 100.0})
      expect_any_order([&] {
        nodal_tangent<B, Material, Material::Tangent>({}, body.level, body.state.u, body.v, over);
        return body.gathered();
      });
  }
}

// Of all the elements of a patch that are inverted at once, the same one is kept.
TYPED_TEST(Teams, KeepOneInvertedElement) {
  using B = TypeParam;
  Body<B> body;
  const State<B> turned{device<B>(disorder(body.n, 0.02, 1)), body.v};
  const auto kept = [&] {
    std::vector<double> all = numbers(body.level.flags.evaluation);
    const auto& word = body.level.flags.word;
    for (std::size_t p = 0; p < word.extent(0); ++p)
      all.push_back(body.level.flags.slot(word(p))),
          all.push_back(static_cast<double>(body.level.flags.J(word(p))));
    return all;
  };
  body.level.flags = make_element_flags<B>(body.model.patches.count);
  expect_any_order([&] {
    body.level.flags.clear({});
    elastic_force<B, Material>({}, body.model.patches, turned, body.level.flags, 1,
                               body.level.partial);
    return kept();
  });
  body.make_nodal(false);
  body.level.flags = make_element_flags<B>(body.model.rows.slices);
  expect_any_order([&] {
    body.level.flags.clear({});
    nodal_force<B, Material>({}, body.level, turned, 1);
    return kept();
  });
}

}  // namespace
