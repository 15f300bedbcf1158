// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <gtest/gtest.h>

#include <plica/core/backend.hpp>
#include <type_traits>

// Typed test lists of the backends that are built.
namespace plica::test {

struct End {};

/// testing::Types of all backends that Keep keeps, up to End.
template <template <class> class Keep, class Kept, class... Rest>
struct Choose;
template <template <class> class Keep, class... Kept>
struct Choose<Keep, testing::Types<Kept...>, End> {
  using type = testing::Types<Kept...>;
};
template <template <class> class Keep, class... Kept, class B, class... Rest>
struct Choose<Keep, testing::Types<Kept...>, B, Rest...>
    : Choose<
          Keep,
          std::conditional_t<Keep<B>::value, testing::Types<Kept..., B>, testing::Types<Kept...>>,
          Rest...> {};

template <class B>
using Any = std::true_type;
template <class B>
using InDouble = std::is_same<typename B::Real, double>;

#define PLICA_TEST_BACKEND(Real, Exec) Backend<Real, Exec>,
using EachBackend =
    Choose<Any, testing::Types<>, PLICA_FOR_EACH_BACKEND(PLICA_TEST_BACKEND) End>::type;
using EachDoubleBackend =
    Choose<InDouble, testing::Types<>, PLICA_FOR_EACH_BACKEND(PLICA_TEST_BACKEND) End>::type;
#undef PLICA_TEST_BACKEND

/// Where physics is tested that does not depend on the backend.
using Host = Backend<double, Kokkos::DefaultHostExecutionSpace>;
using HostFloat = Backend<float, Kokkos::DefaultHostExecutionSpace>;

}  // namespace plica::test
