// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <plica/drivers/app/output/columns.hpp>

// One list of columns, in all forms that it gives.
namespace plica::app::test {
namespace {

struct Fruit {
  std::string name;
  std::optional<double> mass;
  int seeds = 0;
  bool operator==(const Fruit&) const = default;
};

TEST(Table, SaysAndReadsTheSameColumns) {
  const Table<Fruit> table = {{"name", &Fruit::name, {"fruit"}},
                              {"mass", &Fruit::mass, {"mass", "{:.1f} g"}},
                              {"", [](const Fruit& f) { return f.seeds > 0; }},
                              {"seeds", &Fruit::seeds, {"seeds", "{}"}}};
  const std::vector<Fruit> fruits = {{"a \"red\" apple", 150.25, 5}, {"", {}, 12}};
  const auto json = table.json(fruits);
  EXPECT_EQ(json[0].dump(), R"({"name":"a \"red\" apple","mass":150.25,"seeds":5})");
  EXPECT_EQ(with_nulls(json)[1].dump(), R"({"name":null,"mass":null,"seeds":12})");
  std::vector<Fruit> read;
  table.read(with_nulls(json), read);
  EXPECT_EQ(read, fruits);
  EXPECT_THROW(table.read({{{"name", "b"}}}, read), nlohmann::ordered_json::exception);
  EXPECT_EQ(csv_table(json), "name,mass,seeds\n\"a \"\"red\"\" apple\",150.25,5\n,,12\n");
  EXPECT_EQ(csv_table({}), "");
  EXPECT_EQ(table.text(fruits),
            "  fruit             mass  seeds\n"
            "  a \"red\" apple  150.2 g      5\n"
            "                             12\n");
  EXPECT_EQ(table.markdown({{"b", 1, 2}}),
            "| fruit | mass | seeds |\n|---|---|---|\n| b | 1.0 g | 2 |\n");
}

}  // namespace
}  // namespace plica::app::test
