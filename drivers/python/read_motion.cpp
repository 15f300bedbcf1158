// SPDX-License-Identifier: BSD-3-Clause
#include <nlohmann/json.hpp>
#include <plica/drivers/app/scene/reader.hpp>
#include <plica/drivers/python/read_motion.hpp>

namespace plica::python {

Motion read_motion(const std::string& json) {
  const app::Tree tree = app::tree_of(nlohmann::ordered_json::parse(json), "motion");
  Motion motion;
  app::Reader reader({tree, ""});
  reader.one_of();
  describe(reader, motion);
  reader.finish();
  return motion;
}

Turn read_turn(const std::string& json) {
  const app::Tree tree = app::tree_of(nlohmann::ordered_json::parse(json), "turn");
  Turn turn;
  app::Reader reader({tree, ""});
  describe(reader, turn);
  reader.finish();
  return turn;
}

}  // namespace plica::python
