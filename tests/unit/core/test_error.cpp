// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <plica/core/error.hpp>

namespace {

using namespace plica;

TEST(InputError, SaysWhere) {
  EXPECT_STREQ(InputError("bad").what(), "bad");
  EXPECT_STREQ(InputError("bad", {"a.yaml", 12}).what(), "a.yaml:12: bad");
  EXPECT_STREQ(InputError("bad", {"a.yaml", 0}).what(), "a.yaml: bad");
}

TEST(NearestName, FindsMisspellingsAndNothingElse) {
  const std::vector<std::string> choices{"euler", "symplectic_euler", "rk4"};
  EXPECT_EQ(nearest_name("symplectic_eular", choices), "symplectic_euler");
  EXPECT_EQ(nearest_name("eule", choices), "euler");
  EXPECT_EQ(nearest_name("rk5", choices), "rk4");
  EXPECT_EQ(nearest_name("conjugate", choices), "");
  EXPECT_EQ(nearest_name("euler", {}), "");
}

TEST(UnknownName, NamesTheNearestAndAll) {
  EXPECT_EQ(unknown_name("integrator", "rk5", {"euler", "rk4"}),
            "unknown integrator 'rk5'; did you mean 'rk4'? (choices: euler, rk4)");
  EXPECT_EQ(unknown_name("integrator", "wonderful", {"euler", "rk4"}),
            "unknown integrator 'wonderful' (choices: euler, rk4)");
}

}  // namespace
