// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <functional>
#include <optional>
#include <plica/core/keys.hpp>
#include <string>
#include <vector>

namespace plica {

/// Value of a quantity on one mesh, or with one time step.
struct VerifyValue {
  std::string mesh;  ///< cells of the mesh, "40x2x2", or another setting
  double size = 0;   ///< size of the cells, or of the step, in any unit
  double value = 0;  ///< value of the quantity, in the unit of the row
};

/// Rule that decides whether a row is ok.
enum class Judged {
  finest,  ///< the finest value is within the relative tolerance of the accepted one
  /// the limit of the values (Richardson's extrapolation) is within the relative tolerance
  limit,
  size,  ///< no value is larger than the tolerance: an error to round-off
  /// the values are errors; the order at which they fall is within the absolute tolerance of the
  /// accepted one
  order,
  above,   ///< the values fall towards the accepted one from above, as with locking
  nothing  ///< the row is for information
};

/// One quantity of a problem with a known solution, on several meshes.
struct VerifyRow {
  std::string problem = {};        ///< name of the problem, see verify_problems()
  std::string quantity = {};       ///< description of the quantity
  std::string unit = {};           ///< unit of the values; "1": plain numbers
  std::string element = "linear";  ///< kind of elements
  std::string mesh = "regular";    ///< kind of meshes: regular, jittered or delaunay
  /// accepted value of the quantity; with Judged::order the accepted order. None: there is none
  std::optional<double> accepted = {};
  std::string source = {};             ///< source of the accepted value
  std::vector<VerifyValue> ours = {};  ///< computed values, the finest last
  Judged judged = Judged::nothing;     ///< rule that decides whether the row is ok
  double tolerance = 0;                ///< tolerance of the rule, relative or absolute: see Judged
  /// power of the values that is extrapolated: -1 for deflections and 2 for frequencies, which
  /// makes it a stiffness
  double power = 1;
  std::string note = {};             ///< why the values are not those one may expect
  std::optional<double> limit = {};  ///< extrapolated from the last three values
  std::optional<double> order = {};  ///< observed order
  std::string outcome = {};          ///< ok | not ok | shown

  /// Adds a computed value; `of` names its mesh or setting, see VerifyValue.
  void add(const std::string& of, double size, double value) { ours.push_back({of, size, value}); }
};

/// Problems to solve, and how finely.
struct VerifyOptions {
  std::vector<std::string> problems;  ///< names of verify_problems(); empty: all
  bool small = false;                 ///< true: coarser meshes, all in some seconds
};

/// Rows of all problems.
struct VerifyResult {
  std::vector<VerifyRow> rows;  ///< one per quantity, in the order of the problems
  bool stopped = false;         ///< true where the caller ended it early
  bool ok() const;              ///< returns whether no row is "not ok"
};

/// Progress of verify().
struct VerifyProgress {
  std::string doing;                     ///< name of the problem that is solved
  std::size_t done = 0;                  ///< number of problems that are done
  std::size_t of = 0;                    ///< number of chosen problems
  const VerifyResult* so_far = nullptr;  ///< result so far
  bool new_rows = false;                 ///< true where rows were added since the last call
};

/// Function called before every mesh and after every problem; false ends verify().
using VerifyWatch = std::function<bool(const VerifyProgress&)>;

/// Returns all problems with a known solution.
std::vector<Choice> verify_problems();

/// Solves the chosen problems in double on the host. A problem that throws gives a row that is not
/// ok. Throws InputError for an unknown name; the message has the nearest name. Kokkos must be
/// initialised.
VerifyResult verify(const VerifyOptions& options, const VerifyWatch& watch = {});

/// Throws InputError where a name is not in verify_problems().
void check_problems(const std::vector<std::string>& names);

/// Sets limit, order and outcome of a row.
void judge(VerifyRow& row);

}  // namespace plica
