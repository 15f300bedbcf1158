// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <functional>
#include <optional>
#include <plica/core/keys.hpp>
#include <string>
#include <vector>

namespace plica {

/// A quantity as one mesh, or one time step, has it.
struct VerifyValue {
  std::string mesh;  ///< its cells, "40x2x2", or what else was refined
  double size = 0;   ///< of its cells, or of the step, in any unit
  double value = 0;
};

/// What decides whether a row is ok.
enum class Judged {
  finest,  ///< its finest value is within the tolerance of the accepted one, relative
  limit,   ///< what its values tend to is (Richardson's extrapolation)
  size,    ///< no value is larger than the tolerance: an error to round-off
  /// its values are errors; the order at which they fall is within the tolerance of the accepted
  /// one, absolute
  order,
  above,   ///< its values fall towards the accepted one and stay above it: what locks, does
  nothing  ///< it is for information
};

/// One quantity of a problem with a known answer, on several meshes.
struct VerifyRow {
  std::string problem = {}, quantity = {}, unit = {};
  std::string element = "linear";  ///< of its meshes
  std::string mesh = "regular";    ///< these: regular, jittered or delaunay
  std::optional<double> accepted = {};
  std::string source = {};  ///< of the accepted value
  std::vector<VerifyValue> ours = {};
  Judged judged = Judged::nothing;
  double tolerance = 0;
  double power = 1;       ///< the one of its values that is extrapolated: -1 of deflections, 2 of
                          ///< frequencies, so that it is a stiffness
  std::string note = {};  ///< why it is not what one might expect
  std::optional<double> limit = {};  ///< extrapolated from the last three
  std::optional<double> order = {};  ///< observed
  std::string outcome = {};          ///< ok | not ok | shown

  void add(const std::string& of, double size, double value) { ours.push_back({of, size, value}); }
};

struct VerifyOptions {
  std::vector<std::string> problems;  ///< of verify_problems(); empty: all
  bool small = false;                 ///< on coarser meshes: all in some seconds
};

struct VerifyResult {
  std::vector<VerifyRow> rows;
  bool stopped = false;  ///< by the caller, before all was done
  bool ok() const;       ///< no row has the wrong outcome
};

/// How far it is.
struct VerifyProgress {
  std::string doing;
  std::size_t done = 0, of = 0;  ///< problems
  const VerifyResult* so_far = nullptr;
  bool new_rows = false;  ///< since the last call
};

/// Called before every mesh and after every problem; false ends it.
using VerifyWatch = std::function<bool(const VerifyProgress&)>;

/// Every problem with a known answer there is.
std::vector<Choice> verify_problems();

/// Solves them in double on the host. A problem that throws is a row that is not ok. InputError for
/// an unknown name, with the nearest. Kokkos must be initialised.
VerifyResult verify(const VerifyOptions& options, const VerifyWatch& watch = {});

/// InputError where a name is not in verify_problems().
void check_problems(const std::vector<std::string>& names);

/// Fills in limit, order and outcome.
void judge(VerifyRow& row);

}  // namespace plica
