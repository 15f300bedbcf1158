// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <gtest/gtest.h>

#include <plica/drivers/study/sample_gradients.hpp>
#include <plica/kernels/materials/list.hpp>

namespace plica::test {

const Lame<double> soft = lame_constants(20e3, 0.4);

/// test(material) for each of the list.
template <class Test>
void for_each_material(const Test& test) {
  Materials::for_each([&](auto material) {
    SCOPED_TRACE(decltype(material)::name);
    test(material);
  });
}

/// test(name of a material) for each, so that the test is compiled once.
template <class Test>
void for_each_material_name(const Test& test) {
  for_each_material([&](auto material) { test(std::string(material.name)); });
}

}  // namespace plica::test
