// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>
#include <plica/drivers/study/study_reference.hpp>
#include <string>

namespace plica::app {

/// reference.bin: a line of JSON with the digest of what the reference is of, the digest of what follows, its numbers and sizes; then
/// the states, as doubles.
std::string reference_bytes(const StudyReference& reference, std::uint64_t digest);

/// None where the bytes are no such file, are damaged, or are of another problem.
std::optional<StudyReference> parse_reference(const std::string& bytes, std::uint64_t digest);

}  // namespace plica::app
