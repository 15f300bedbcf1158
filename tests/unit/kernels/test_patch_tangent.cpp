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
void expect_its_change(const Disordered<B>& on) {
  expect_the_sum<B, M>(on, &on.p, [&](const Patches<B>& patches) {
    return ElasticTangent<B, M>{{on.u_here, on.p_here}, patches.constants, {}};
  });
}

TYPED_TEST(PatchTangentOn, IsTheSumOverTheElements) {
  const Disordered<TypeParam> on;
  Materials::for_each([&](auto material) { expect_its_change<TypeParam, decltype(material)>(on); });
}

TYPED_TEST(PatchTangentOn, TakesAMaterialOfThreeConstants) {
  expect_its_change<TypeParam, ThreeConstants>({});
}

}  // namespace
