// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace plica::app {

/// A table of numbers (.csv with a head) as {column: [values]}, at most `rows` of them, evenly, the last among them. InputError with
/// file and line where it is none.
nlohmann::ordered_json read_columns(const std::filesystem::path& csv, std::size_t rows);

/// A JSON file with these members. InputError where it is none.
nlohmann::ordered_json read_json(const std::filesystem::path& file, const std::vector<std::string>& keys);

}  // namespace plica::app
