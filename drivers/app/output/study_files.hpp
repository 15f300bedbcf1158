// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>
#include <plica/drivers/app/output/study_table.hpp>
#include <plica/drivers/app/output/write_file.hpp>
#include <plica/drivers/study/study_run.hpp>
#include <string>

namespace plica::app {

/// Returns the contents of reference.bin: a line of JSON, then the states as doubles. The line has
/// the digest of the problem, the digest of the states, and numbers and sizes of the reference.
/// @param digest  digest of the problem and options that the reference belongs to
std::string reference_bytes(const StudyReference& reference, std::uint64_t digest);

/// Reads the contents of reference.bin. Returns none if the bytes are no such file, are damaged, or
/// have another digest of the problem.
std::optional<StudyReference> parse_reference(const std::string& bytes, std::uint64_t digest);

/// Files of a study: study.json, study.csv and reference.bin. The first two are replaced as a
/// whole; reference.bin has the states against which errors are measured.
class StudyFiles {
 public:
  /// Prepares the files in `folder`. Needs Kokkos, to describe the machine.
  StudyFiles(const Scene& scene, const StudyOptions& options, const std::filesystem::path& folder);

  const std::filesystem::path& folder() const { return folder_; }
  const StudyMachine& machine() const { return machine_; }

  /// Returns the results in the folder that still apply. The reference applies if it is of this
  /// problem, the rows if they are of this scene, options, program and machine.
  StudyResult read() const;
  /// Returns true if the folder has rows of another study.
  bool holds_another() const;
  /// Returns study.json and study.csv, to be written.
  /// @param status   completed | interrupted | unfinished
  /// @param stopped  key of the case that was interrupted; empty: none
  std::vector<FileBytes> texts(const StudyResult& result, const std::string& status,
                               const std::string& stopped = {}) const;
  /// Writes reference.bin.
  void write_reference(const StudyReference& reference) const;

 private:
  std::filesystem::path folder_;
  StudyHead head_;
  StudyMachine machine_;
  std::uint64_t reference_digest_ = 0;
};

}  // namespace plica::app
