// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "unit/app/child.hpp"

// plica doctor
namespace plica::app::test {
namespace {

using Json = nlohmann::json;

TEST(DoctorCommand, MeasuresTheMachineAndFindsTheStoredAnswer) {
  const TemporaryFolder folder;
  const Child run = run_child({PLICA_EXECUTABLE, "doctor", "--json", "--threads", "1"}, folder);
  EXPECT_EQ(run.status, 0) << run.output << run.errors;
  const Json found = Json::parse(run.output), limits = found.at("limits"),
             test = found.at("self_test");
  EXPECT_EQ(found["machine"]["threads"], 1);
  EXPECT_EQ(found["vector_bytes"], PLICA_VECTOR_BYTES);
  for (const char* name : {"memory_bandwidth", "cache_bandwidth", "flops_double", "flops_float"})
    EXPECT_GT(limits.at(name).get<double>(), 1e7) << name;
  EXPECT_TRUE(test["ok"].get<bool>());
  ASSERT_EQ(test["answers"].size(), 5u);
  for (const Json& answer : test["answers"]) {
    const double miss = std::abs(answer["got"].get<double>() - answer["stored"].get<double>());
    EXPECT_LE(miss, answer["tolerance"].get<double>()) << answer;
    EXPECT_LT(answer["tolerance"].get<double>(), 0.02 * std::abs(answer["stored"].get<double>()))
        << answer;
  }
}

TEST(DoctorCommand, SaysItForPeopleToo) {
  const TemporaryFolder folder;
  const Child run = run_child({PLICA_EXECUTABLE, "doctor", "--threads", "1"}, folder);
  EXPECT_EQ(run.status, 0) << run.errors;
  for (const char* word : {"back end", "GB/s", "Gflop/s", "all ok"})
    EXPECT_NE(run.output.find(word), std::string::npos) << word << " in\n" << run.output;
}

}  // namespace
}  // namespace plica::app::test
