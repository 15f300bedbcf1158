// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <plica/drivers/app/output/contact_depth.hpp>
#include <plica/drivers/app/output/inside_out.hpp>
#include <plica/drivers/run/energy_meter.hpp>
#include <plica/kernels/contact/shapes.hpp>

#include "support/refusal.hpp"

// What the frames of a run have shown, saved and restored.
namespace plica::app {
namespace {

using plica::test::refusal;

ContactDepth depth_in_two() {
  ContactOptions contact;
  contact.obstacles = {{PlaneOptions{}, {}, {}}, {SphereOptions{{0, 0, 0}, 0.01}, {}, {}}};
  return {contact, 0.01, {}, true};
}

/// Saved values are restored as a whole, or refused: fewer or more of them are no saved state.
template <class Shown>
void expect_restored(const Shown& shown, Shown other, const char* what) {
  const std::vector<double> saved = shown.save();
  for (const std::size_t values : {std::size_t{0}, saved.size() - 1, saved.size() + 1}) {
    std::vector<double> wrong = saved;
    wrong.resize(values);
    EXPECT_EQ(refusal([&] { other.restore(wrong); }),
              "the saved state is damaged: it has " + std::to_string(values) + " values of " +
                  what + "; expected " + std::to_string(saved.size()));
  }
  EXPECT_NE(other.save(), saved);
  other.restore(saved);
  EXPECT_EQ(other.save(), saved);
  EXPECT_EQ(other.warning(), shown.warning());
}

TEST(SavedValues, OfContactDepths) {
  ContactDepth shown = depth_in_two();
  shown.look(0.5, {0.02, 0.003}, {1}, 0.001);
  EXPECT_NE(shown.warning(), "");
  expect_restored(shown, depth_in_two(), "contact depths");
}

TEST(SavedValues, OfInvertedElements) {
  const MaterialOptions material{"corotational", 1e4, 0.3, 1000};
  InsideOut shown(material);
  ASSERT_TRUE(shown.looks());
  shown.look(0.25, {false, {1, 1, 1}, {0.5, -0.25, -0.5}});
  EXPECT_NE(shown.warning(), "");
  expect_restored(shown, InsideOut(material), "inverted elements");
}

TEST(SavedValues, OfTheEnergyBudget) {
  EnergyBudget shown;
  Energies e;
  e.kinetic = 1;
  shown.look(0.1, e);
  e.kinetic = 3;
  shown.look(0.2, e, 0.5);
  EXPECT_NE(shown.warning(), "");
  expect_restored(shown, EnergyBudget(), "the energy budget");
}

}  // namespace
}  // namespace plica::app
