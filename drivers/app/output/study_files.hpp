// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>
#include <plica/drivers/app/output/study_table.hpp>
#include <plica/drivers/app/output/write_file.hpp>
#include <plica/drivers/study/study_run.hpp>
#include <string>

namespace plica::app {

/// reference.bin: a line of JSON with the digest of what the reference is of, the digest of what
/// follows, its numbers and sizes; then the states, as doubles.
std::string reference_bytes(const StudyReference& reference, std::uint64_t digest);

/// None where the bytes are no such file, are damaged, or are of another problem.
std::optional<StudyReference> parse_reference(const std::string& bytes, std::uint64_t digest);

/// A study's files: study.json, study.csv, each replaced as a whole, and reference.bin, what errors
/// are measured against.
class StudyFiles {
 public:
  /// Needs Kokkos for what it says of the machine.
  StudyFiles(const Scene& scene, const StudyOptions& options, const std::filesystem::path& folder);

  const std::filesystem::path& folder() const { return folder_; }
  const StudyMachine& machine() const { return machine_; }

  /// The rows in the folder, where they are of the same scene, options, program and machine, and
  /// the reference, where it is of the same problem.
  StudyResult read() const;
  /// Whether it has the rows of another study.
  bool holds_another() const;
  /// study.json and study.csv; status: completed | interrupted | unfinished. `stopped`: the case
  /// that was interrupted.
  std::vector<MemoryFile> texts(const StudyResult& result, const std::string& status,
                                const std::string& stopped = {}) const;
  void write_reference(const StudyReference& reference) const;

 private:
  std::filesystem::path folder_;
  StudyHead head_;
  StudyMachine machine_;
  std::uint64_t reference_digest_ = 0;
};

}  // namespace plica::app
