// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <plica/kernels/elastic/elastic_tangent.hpp>

#include "support/backends.hpp"
#include "support/plain_elements.hpp"
#include "support/three_constants.hpp"

// The change of the elastic force, see test_patch_kernel.cpp.
namespace {

using namespace plica;
using namespace plica::test;

template <class B>
class PatchTangentOn : public testing::Test {};
TYPED_TEST_SUITE(PatchTangentOn, EachBackend);

template <class B, class M>
void expect_the_sum(const Disordered<B>& on) {
  SCOPED_TRACE(M::name);
  const Patches<B> patches = build_patches<B>(on.mesh, {as_list(sample_constants<M>())});
  const ElasticTangent<B, M> tangent{{on.u_here, on.p_here}, patches.constants, {}};
  expect_close<typename B::Real>(through_patches(on.mesh, patches, tangent),
                                 plain_force(stress_of<M>, on.mesh, on.u, &on.p));
}

TYPED_TEST(PatchTangentOn, IsTheSumOverTheElements) {
  const Disordered<TypeParam> on;
  Materials::for_each([&](auto material) { expect_the_sum<TypeParam, decltype(material)>(on); });
}

TYPED_TEST(PatchTangentOn, TakesAMaterialOfThreeConstants) { expect_the_sum<TypeParam, ThreeConstants>({}); }

}  // namespace
