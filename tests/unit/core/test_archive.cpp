// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <plica/core/archive.hpp>
#include <plica/core/level_data.hpp>

#include "support/backends.hpp"
#include "support/refusal.hpp"

// What a class names to an archive: its arrays are counted, what it carries is saved and kept.
namespace {

using namespace plica;
using namespace plica::test;

using Bytes = std::vector<unsigned char>;

template <class B>
struct Nested {
  int n = 0;
  Scalars<B> scalars;
  Kokkos::Array<Vectors<B>, 2> pair;
};
template <class B>
struct Outer {
  double x = 0;
  Nested<B> nested;
  std::vector<State<B>> states;
};

template <class B>
class Carrier {
 public:
  explicit Carrier(int vertices) : state_("test.state", vertices), work_("test.work", 7) {}
  void name_fields(Archive<B>& archive) {
    archive.number(count_), archive.state("state", state_), archive.number(is_new_);
    archive.owns(work_, state_);
  }
  void set(double value) {
    fill(typename B::Exec(), state_.u, static_cast<typename B::Real>(value));
    fill(typename B::Exec(), state_.v, static_cast<typename B::Real>(-value / 3));
    count_ = static_cast<long>(7 * value), is_new_ = value > 1;
  }
  Bytes saved() {
    Bytes bytes;
    Archive<B> archive(Archive<B>::Task::save, bytes);
    name_fields(archive);
    return bytes;
  }
  /// Carries out a task that reads the bytes.
  void read(typename Archive<B>::Task task, Bytes bytes) {
    Archive<B> archive(task, bytes);
    name_fields(archive);
    archive.finish();
  }
  void exchange(typename Archive<B>::Task task, KeptValues<B>& kept) {
    Archive<B> archive(task, kept, typename B::Exec());
    name_fields(archive);
  }

 private:
  State<B> state_;
  Scalars<B> work_;
  long count_ = 0;
  bool is_new_ = true;
};

template <class B>
class ArchiveOf : public testing::Test {};
TYPED_TEST_SUITE(ArchiveOf, EachBackend);

TYPED_TEST(ArchiveOf, CountsEachArrayOnce) {
  using B = TypeParam;
  constexpr std::size_t real = sizeof(typename B::Real);
  Outer<B> outer;
  Archive<B> archive;
  archive.owns(outer);
  EXPECT_EQ(archive.measured(), 0U);
  outer.nested.scalars = zeros<Scalars<B>>("test.scalars", 5);
  for (auto& one : outer.nested.pair) one = zeros<Vectors<B>>("test.pair", 3);
  outer.states.emplace_back("test.state", 2);
  archive.owns(outer, outer.nested.pair);
  EXPECT_EQ(archive.measured(), (5 + 2 * 9 + 12) * real);
  const Outer<B> copy = outer;
  archive.owns(copy);
  each_array(outer, [](auto& array) { array = lent(array); });
  Archive<B> other;
  other.owns(outer);
  EXPECT_EQ(archive.measured() + other.measured(), 0U) << "shared and lent arrays";
  Carrier<B> carrier(4);
  carrier.name_fields(other);
  EXPECT_EQ(other.measured(), (24 + 7) * real);
}

// A member more or less must not go unnoticed.
TYPED_TEST(ArchiveOf, KnowsTheMembersOfTheLevelsArrays) {
  using B = TypeParam;
  const auto arrays = [](auto object) {
    int n = 0;
    each_array(object, [&](auto&) { ++n; });
    return n;
  };
  EXPECT_EQ(arrays(Transfer<B>{}), 3);
  EXPECT_EQ(arrays(EmbeddedSurface<B>{}), 10);
  EXPECT_EQ(arrays(Patches<B>{}), 16);
  EXPECT_EQ(arrays(NodalRows<B>{}), 20);
  EXPECT_EQ(arrays(ViscousHistory<B>{}), 4);
}

TYPED_TEST(ArchiveOf, RestoresAndPutsBackToTheBit) {
  using B = TypeParam;
  using Task = typename Archive<B>::Task;
  Carrier<B> one(4), other(4);
  one.set(1.0 / 3);
  const Bytes saved = one.saved();
  EXPECT_EQ(saved.size(), sizeof(long) + 2 * (8 + 12 * sizeof(typename B::Real)) + 1);
  KeptValues<B> kept;
  one.exchange(Task::keep, kept);
  one.set(2.0 / 3);
  EXPECT_NE(one.saved(), saved);
  one.exchange(Task::put_back, kept);
  EXPECT_EQ(one.saved(), saved);
  other.read(Task::check, saved);
  EXPECT_NE(other.saved(), saved);
  other.read(Task::restore, saved);
  EXPECT_EQ(other.saved(), saved);
  Bytes of_kept;
  Archive<B> archive(Task::save, of_kept);
  kept.name_fields(archive);
  EXPECT_EQ(of_kept, saved);
  EXPECT_EQ(refusal([&] { Carrier<B>(5).read(Task::check, saved); }),
            "the saved state is that of another simulation: the size of state.u differs");
}

}  // namespace
