// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/app/output/study_json.hpp>
#include <plica/drivers/app/output/write_file.hpp>

namespace plica::app {

/// A study's files: study.json, study.csv, each replaced as a whole, and reference.bin, what errors are measured against.
class StudyFiles {
 public:
  /// Needs Kokkos for what it says of the machine.
  StudyFiles(const Scene& scene, const StudyOptions& options, const std::filesystem::path& folder);

  const std::filesystem::path& folder() const { return folder_; }
  const StudyMachine& machine() const { return machine_; }

  /// The rows in the folder, where they are of the same scene, options, program and machine, and the reference, where it is of
  /// the same problem.
  StudyResult read() const;
  void write(const StudyResult& result, const std::string& status) const;
  void write_reference(const StudyReference& reference) const;

 private:
  std::filesystem::path folder_;
  StudyHead head_;
  StudyMachine machine_;
  std::uint64_t reference_digest_ = 0;
};

}  // namespace plica::app
