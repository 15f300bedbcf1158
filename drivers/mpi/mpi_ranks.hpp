// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <mpi.h>

#include <plica/core/ranks.hpp>
#include <plica/drivers/mpi/waiting.hpp>

namespace plica {

/// The processes of an MPI communicator. MPI is initialised before, and finalised after the last
/// object; errors of MPI itself end the program, as it does by default.
class MpiRanks final : public Ranks {
 public:
  /// Duplicates the communicator. All its processes call this.
  explicit MpiRanks(MPI_Comm comm, Waiting waiting = {});
  ~MpiRanks() override;
  MpiRanks(const MpiRanks&) = delete;
  MpiRanks& operator=(const MpiRanks&) = delete;

  int count() const override { return count_; }
  int own() const override { return own_; }
  bool device_pointers() const override { return device_pointers_; }
  std::unique_ptr<Exchange> open(std::string what, std::vector<Outgoing> sent,
                                 std::vector<Incoming> received) override;
  void sum(std::span<std::int64_t> values) override;
  void most(std::span<double> values) override;
  std::vector<Bytes> gather(std::span<const std::byte> bytes) override;
  std::vector<Bytes> to_all(const std::vector<Bytes>& for_each) override;
  Traffic traffic() const override { return traffic_; }

 private:
  class Messages;
  MPI_Comm comm() const { return tells_failure() ? failures_ : comm_; }
  void combine(std::span<std::int64_t> values, MPI_Op operation, const char* what);
  void finish(std::span<MPI_Request> requests, std::span<const int> ranks, const std::string& what);
  void say_waiting(std::span<MPI_Request> requests, std::span<const int> ranks,
                   const std::string& what) const;

  MPI_Comm comm_ = MPI_COMM_NULL, failures_ = MPI_COMM_NULL;
  Waiting waiting_;
  int count_ = 1, own_ = 0, opened_ = 0, largest_tag_ = 0;
  bool device_pointers_ = false;
  Traffic traffic_;
  std::vector<std::int64_t>
      keys_;  // values of most(), which a failure may leave before they are there
};

}  // namespace plica
