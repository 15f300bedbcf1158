// SPDX-License-Identifier: BSD-3-Clause
#include <sched.h>

#include <algorithm>
#include <bit>
#include <exception>
#include <limits>
#include <plica/core/text.hpp>
#include <plica/drivers/mpi/mpi_ranks.hpp>
#include <stdexcept>
#include <thread>
#if defined(OPEN_MPI)
#include <mpi-ext.h>
#endif

namespace plica {
namespace {

using Clock = std::chrono::steady_clock;

bool sends_device_memory() {
#if defined(MPIX_CUDA_AWARE_SUPPORT) && MPIX_CUDA_AWARE_SUPPORT
  return MPIX_Query_cuda_support() == 1;
#elif defined(MPIX_GPU_SUPPORT_CUDA)
  int supported = 0;
  return MPIX_GPU_query_support(MPIX_GPU_SUPPORT_CUDA, &supported) == MPI_SUCCESS && supported == 1;
#else
  return false;
#endif
}

// Numbers as integers of the same order. NaN, of either sign, is the largest.
std::int64_t to_ordered(double value) {
  if (value != value) return std::numeric_limits<std::int64_t>::max();
  const auto bits = std::bit_cast<std::int64_t>(value);
  return bits < 0 ? bits ^ std::numeric_limits<std::int64_t>::max() : bits;
}

double from_ordered(std::int64_t key) {
  if (key == std::numeric_limits<std::int64_t>::max())
    return std::numeric_limits<double>::quiet_NaN();
  return std::bit_cast<double>(key < 0 ? key ^ std::numeric_limits<std::int64_t>::max() : key);
}

// Calls work(begin, size) for parts of at most `largest` bytes.
template <class Work>
void in_parts(std::size_t bytes, std::size_t largest, const Work& work) {
  for (std::size_t begin = 0; begin < bytes; begin += largest)
    work(begin, static_cast<int>(std::min(largest, bytes - begin)));
}

// Requests with the rank at the other end of each.
struct Requests {
  std::vector<MPI_Request> all;
  std::vector<int> ranks;
  MPI_Request* next(int rank) {
    ranks.push_back(rank);
    return &all.emplace_back(MPI_REQUEST_NULL);
  }
};

constexpr int tag_of_parts = 0;  // exchanges have those from 1 on

}  // namespace

/// Messages of one exchange, as persistent requests.
class MpiRanks::Messages final : public Exchange {
 public:
  Messages(MpiRanks& of, std::string what, const std::vector<Outgoing>& sent,
           const std::vector<Incoming>& received, int tag)
      : of_(of), what_(std::move(what)) {
    const std::size_t largest = of.waiting_.largest_message;
    for (const Incoming& in : received)
      in_parts(in.bytes.size(), largest, [&](std::size_t begin, int size) {
        MPI_Recv_init(in.bytes.data() + begin, size, MPI_BYTE, in.rank, tag, of.comm_,
                      requests_.next(in.rank));
      });
    for (const Outgoing& out : sent)
      in_parts(out.bytes.size(), largest, [&](std::size_t begin, int size) {
        MPI_Send_init(out.bytes.data() + begin, size, MPI_BYTE, out.rank, tag, of.comm_,
                      requests_.next(out.rank));
        ++each_.messages, each_.bytes += size;
      });
  }
  ~Messages() override {
    int over = 0;
    MPI_Finalized(&over);
    for (MPI_Request& request : requests_.all)
      if (over == 0) MPI_Request_free(&request);
  }
  Messages(const Messages&) = delete;
  Messages& operator=(const Messages&) = delete;

  void start() override {
    of_.traffic_.messages += each_.messages, of_.traffic_.bytes += each_.bytes;
    if (requests_.all.empty()) return;  // some MPIs refuse to start none
    MPI_Startall(static_cast<int>(requests_.all.size()), requests_.all.data());
  }
  void wait() override { of_.finish(requests_.all, requests_.ranks, what_); }

 private:
  MpiRanks& of_;
  std::string what_;
  Requests requests_;
  Traffic each_;  // messages and bytes of one start()
};

MpiRanks::MpiRanks(MPI_Comm comm, Waiting waiting)
    : waiting_(std::move(waiting)), device_pointers_(sends_device_memory()) {
  MPI_Comm_dup(comm, &comm_);
  MPI_Comm_dup(comm, &failures_);
  MPI_Comm_size(comm_, &count_);
  MPI_Comm_rank(comm_, &own_);
  int* largest = nullptr;
  int known = 0;
  MPI_Comm_get_attr(comm_, MPI_TAG_UB, &largest, &known);
  largest_tag_ = known != 0 ? *largest : 32767;  // which every MPI has
}

MpiRanks::~MpiRanks() {
  int over = 0;
  MPI_Finalized(&over);
  if (over == 0) MPI_Comm_free(&comm_), MPI_Comm_free(&failures_);
}

std::unique_ptr<Exchange> MpiRanks::open(std::string what, std::vector<Outgoing> sent,
                                         std::vector<Incoming> received) {
  const int tag = 1 + opened_++ % largest_tag_;
  return std::make_unique<Messages>(*this, std::move(what), sent, received, tag);
}

void MpiRanks::sum(std::span<std::int64_t> values) { combine(values, MPI_SUM, "a sum"); }

void MpiRanks::most(std::span<double> values) {
  keys_.resize(values.size());
  std::ranges::transform(values, keys_.begin(), to_ordered);
  combine(keys_, MPI_MAX, "the largest value");
  std::ranges::transform(keys_, values.begin(), from_ordered);
}

void MpiRanks::combine(std::span<std::int64_t> values, MPI_Op operation, const char* what) {
  ++traffic_.sums;
  MPI_Request request;
  MPI_Iallreduce(MPI_IN_PLACE, values.data(), static_cast<int>(values.size()), MPI_INT64_T,
                 operation, comm(), &request);
  finish({&request, 1}, {}, what);
}

std::vector<Bytes> MpiRanks::gather(std::span<const std::byte> bytes) {
  const auto ranks = static_cast<std::size_t>(count_);
  const std::string what = "data of each rank";
  std::vector<std::size_t> sizes(ranks);
  const std::size_t own_size = bytes.size();
  MPI_Request request;
  MPI_Iallgather(&own_size, sizeof own_size, MPI_BYTE, sizes.data(), sizeof own_size, MPI_BYTE,
                 comm(), &request);
  finish({&request, 1}, {}, what);
  std::vector<Bytes> all(ranks);
  const std::size_t part = std::max<std::size_t>(waiting_.largest_message / ranks, 1);
  const std::size_t most_bytes = *std::ranges::max_element(sizes);
  for (std::size_t begin = 0; begin < most_bytes; begin += part) {
    const auto in_part = [&](std::size_t size) {
      return static_cast<int>(std::min(part, size - std::min(begin, size)));
    };
    std::vector<int> counts(ranks), first(ranks, 0);
    std::ranges::transform(sizes, counts.begin(), in_part);
    for (std::size_t r = 1; r < ranks; ++r) first[r] = first[r - 1] + counts[r - 1];
    Bytes received(static_cast<std::size_t>(first.back() + counts.back()));
    MPI_Iallgatherv(bytes.data() + std::min(begin, own_size), in_part(own_size), MPI_BYTE,
                    received.data(), counts.data(), first.data(), MPI_BYTE, comm(), &request);
    finish({&request, 1}, {}, what);
    for (std::size_t r = 0; r < ranks; ++r)
      all[r].insert(all[r].end(), received.begin() + first[r],
                    received.begin() + first[r] + counts[r]);
  }
  return all;
}

std::vector<Bytes> MpiRanks::to_all(const std::vector<Bytes>& for_each) {
  const auto ranks = static_cast<std::size_t>(count_);
  if (for_each.size() != ranks)
    throw std::logic_error(
        text("to_all() has ", for_each.size(), " parts; expected one a rank, ", count_));
  const std::string what = "data for each rank";
  std::vector<std::size_t> sent(ranks), received(ranks);
  std::ranges::transform(for_each, sent.begin(), &Bytes::size);
  MPI_Request request;
  MPI_Ialltoall(sent.data(), sizeof(std::size_t), MPI_BYTE, received.data(), sizeof(std::size_t),
                MPI_BYTE, comm_, &request);
  finish({&request, 1}, {}, what);
  std::vector<Bytes> all(ranks);
  Requests requests;
  for (int r = 0; r < count_; ++r) {
    const auto i = static_cast<std::size_t>(r);
    if (r == own_) {
      all[i] = for_each[i];
      continue;
    }
    all[i].resize(received[i]);
    in_parts(received[i], waiting_.largest_message, [&](std::size_t begin, int size) {
      MPI_Irecv(all[i].data() + begin, size, MPI_BYTE, r, tag_of_parts, comm_, requests.next(r));
    });
    in_parts(sent[i], waiting_.largest_message, [&](std::size_t begin, int size) {
      MPI_Isend(for_each[i].data() + begin, size, MPI_BYTE, r, tag_of_parts, comm_,
                requests.next(r));
    });
  }
  finish(requests.all, requests.ranks, what);
  return all;
}

// Returns when all requests are done. It lets other processes run meanwhile: some MPIs spin, and
// with more ranks than cores the rank that is waited for then hardly runs. `ranks` are those at the
// other end of each request; empty: a call of all ranks.
void MpiRanks::finish(std::span<MPI_Request> requests, std::span<const int> ranks,
                      const std::string& what) {
  if (requests.empty()) return;
  const Clock::time_point start = Clock::now();
  bool said = false;
  int done = 0;
  while (true) {
    MPI_Testall(static_cast<int>(requests.size()), requests.data(), &done, MPI_STATUSES_IGNORE);
    const Clock::duration since = Clock::now() - start;
    if (done != 0) {
      traffic_.waited += std::chrono::duration<double>(since).count();
      return;
    }
    if (!own_failure().empty() && since > waiting_.patience) throw UnheardFailure(own_failure());
    if (!said && since > waiting_.patience && std::uncaught_exceptions() > 0) {
      if (waiting_.say)
        waiting_.say(text("rank ", own_, " failed while others wait for it; all are ended"));
      MPI_Abort(comm_, 1);
    }
    if (!said && since > waiting_.patience) say_waiting(requests, ranks, what), said = true;
    if (since > std::chrono::seconds(1))
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    else
      sched_yield();
  }
}

void MpiRanks::say_waiting(std::span<MPI_Request> requests, std::span<const int> ranks,
                           const std::string& what) const {
  if (!waiting_.say) return;
  // In a call of all ranks nobody knows who is late: two say it, in case that it is rank 0.
  if (ranks.empty()) {
    if (own_ < 2) waiting_.say(text("rank ", own_, " waits for another rank: ", what));
    return;
  }
  for (std::size_t i = 0; i < requests.size(); ++i) {
    int done = 0;
    MPI_Request_get_status(requests[i], &done, MPI_STATUS_IGNORE);
    if (done != 0) continue;
    return waiting_.say(text("rank ", own_, " waits for rank ", ranks[i], ": ", what));
  }
}

}  // namespace plica
