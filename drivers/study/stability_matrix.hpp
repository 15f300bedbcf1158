// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <functional>
#include <plica/core/problem.hpp>
#include <string>
#include <vector>

namespace plica {

/// What a run may come to. At least one is true.
struct Expected {
  bool complete = false;     ///< it reaches its end
  bool stop = false;         ///< it is stopped with a diagnosis
  bool refuse = false;       ///< its set-up says no
  std::string kind = {};     ///< of the diagnosis; empty: any that fits what is run
  std::string text() const;  ///< "completed or stopped"
};

/// One run of the matrix.
struct MatrixCase {
  std::string name;    ///< "E = 1e+10 Pa, linear"
  std::string method;  ///< as of a study
  Problem problem;     ///< complete but for its macro step
  double step =
      0;  ///< that, times the critical step of its finest level (of an implicit one symplectic Euler's); 0: auto
  long macro_steps = 0;
  std::vector<Point> displacement;  ///< at the start [m]; empty: as the problem says
  Expected expected;
};

/// What it came to.
struct MatrixRow {
  std::string name, method, expected;
  std::string
      outcome;  ///< completed | stopped: KIND | refused | not finite | no diagnosis; of an invariance how much differs
  bool ok = false;
  std::string detail;  ///< diagnosis or message
};

struct MatrixResult {
  std::vector<MatrixRow> rows;
  bool stopped = false;      ///< by the caller, before all was done
  std::size_t left_out = 0;  ///< cases that were not run then
  bool ok() const;           ///< every row is
};

/// How much of it.
enum class MatrixSize {
  whole,  ///< every value, material and method
  small,  ///< of each line its last value, with an explicit level alone and him
};

/// Whether an element that turns inside out ends the run.
bool forbids_inversion(const std::string& material);

/// Every case, from one table; what each must come to follows from rules that are stated there.
std::vector<MatrixCase> stability_matrix(MatrixSize size = MatrixSize::whole);

/// Runs one. A state that the caller could write and that is not finite, a diagnosis that does not say where, or a kind that
/// cannot be are never what was expected.
MatrixRow run_case(const MatrixCase& one);

/// Whether turned, moved, renumbered bodies and other units of length give the same answers: a row for each of them and each method.
std::vector<std::function<MatrixRow()>> invariance_cases(MatrixSize size = MatrixSize::whole);

/// Called after every row with how many there will be; false stops it.
using MatrixWatch = std::function<bool(const MatrixResult&, std::size_t)>;

MatrixResult run_matrix(const std::vector<MatrixCase>& cases, const std::vector<std::function<MatrixRow()>>& more,
                        const MatrixWatch& watch = {});

}  // namespace plica
