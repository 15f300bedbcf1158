// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <functional>
#include <plica/core/problem.hpp>
#include <string>
#include <vector>

namespace plica {

/// Body of the stability matrix, and the facts that predict its run.
struct MatrixBody {
  Problem problem;
  std::vector<Point> displacement;  ///< at the start [m]; empty: none
  /// macro step over the finest critical step; 0: that of the method
  double step = 0;
  double load_ratio = 1e-4;  ///< rho g L / E, from which gravity follows; 0: none
  /// Shape at the start.
  enum class Start { rest, stretched, thin, flat, turned, mirrored, random } start = Start::rest;
  double impact = 0;      ///< impact speed over the wave speed
  bool refused = false;   ///< true where the step is above the limit
  bool unstable = false;  ///< true where the step is above the limit and allowed
  bool apart = false;     ///< true where the levels lie at different places

  /// Returns the largest strain, about. A cantilever four times as long as thick has a strain of 12
  /// times the load ratio at rest, and 24 times when it is released.
  double strain() const { return 24 * load_ratio; }
  bool inside_out() const { return start >= Start::flat; }  ///< true: some J <= 0 at the start
  void load();                                              ///< sets gravity
};

/// Returns a beam of 0.4 x 0.1 x 0.1 m, clamped at x = 0. Its levels have 192 and 24 tetrahedra.
MatrixBody clamped_beam();

/// Makes one layer of cells of level 0 thinner: its width is `ratio` times its thickness.
void set_slivers(MatrixBody& body, double ratio);

/// A line of the matrix: one property of the body that varies.
struct MatrixLine {
  /// Methods with which a line is run.
  enum class Of { all, implicit_alone, him, explicit_alone };
  const char* format;          ///< name of a case; %g stands for the value
  std::vector<double> values;  ///< values in SI units, the most extreme last
  void (*set)(MatrixBody& body, double value);
  Of of = Of::all;
};

/// Returns the lines of the matrix.
const std::vector<MatrixLine>& matrix_lines();

/// Outcomes that a run may have. At least one is true.
struct Expected {
  bool complete = false;     ///< the run completes
  bool stop = false;         ///< the run is stopped with a diagnosis
  bool refuse = false;       ///< the set-up refuses
  std::string kind = {};     ///< kind of the diagnosis; empty: any that this run can have
  std::string why = {};      ///< why more than one is right; empty where only one is
  std::string text() const;  ///< "completed or stopped"
};

/// One run of the matrix.
struct MatrixCase {
  std::string name;    ///< "E = 1e+10 Pa, linear"
  std::string method;  ///< name of a method, see StudyCase::method
  Problem problem;     ///< complete except for its macro step
  /// macro step over the critical step of the finest level; an implicit level has that of
  /// symplectic Euler; 0: auto
  double step = 0;
  long macro_steps = 0;
  std::vector<Point> displacement;  ///< at the start [m]; empty: as the problem says
  Expected expected;
};

/// Outcome of a case.
struct MatrixRow {
  std::string name, method, expected;
  /// completed | stopped: KIND | refused | not finite | no diagnosis; for an invariance the
  /// relative difference
  std::string outcome;
  bool ok = false;
  std::string detail;    ///< diagnosis or message
  std::string why = {};  ///< see Expected
};

/// Outcomes of all cases.
struct MatrixResult {
  std::vector<MatrixRow> rows;
  bool stopped = false;      ///< true where the caller ended it early
  std::size_t left_out = 0;  ///< number of cases that were not run
  bool ok() const;           ///< returns whether every row is ok
};

/// Size of the matrix.
enum class MatrixSize {
  whole,  ///< every value, material and method
  small,  ///< the last value of each line, with an explicit level alone and him
};

/// Returns whether an element of this material ends the run when it turns inside out.
bool forbids_inversion(const std::string& material);

/// Returns every case, from one table. The outcome that each must have follows from the rules at
/// expected_of(), in matrix_cases.cpp.
std::vector<MatrixCase> stability_matrix(MatrixSize size = MatrixSize::whole);

/// Returns the cases of every tissue and law of tissue, of fibres, softening and relaxation, with
/// linear and nodal elements. They are the last cases of the whole matrix.
std::vector<MatrixCase> tissue_cases();

/// Runs one case. The row is never ok where a state that a caller can write is not finite. It is
/// also never ok where a diagnosis does not say its place, or its kind is impossible in this run.
MatrixRow run_case(const MatrixCase& one);

/// Returns the cases that check invariance: turned, moved and renumbered bodies and other units of
/// length must move alike. Each case is one row: one change with one material and one method.
std::vector<std::function<MatrixRow()>> invariance_cases(MatrixSize size = MatrixSize::whole);

/// Returns the cases of organs with tools. An irregular liver is dropped, poked, dragged along,
/// pierced at, grasped and swung; other cases are two organs and a folded tube. They are run by
/// every stepper, with linear and nodal elements, nu 0.3 to 0.49, steps of 1 to 10 ms. Each must
/// complete.
std::vector<std::function<MatrixRow()>> organ_cases(MatrixSize size = MatrixSize::whole);

/// Function called after every row with the total number of rows; false stops the matrix.
using MatrixWatch = std::function<bool(const MatrixResult&, std::size_t)>;

/// Runs the cases, then the functions of `more`, each of which makes a row.
MatrixResult run_matrix(const std::vector<MatrixCase>& cases,
                        const std::vector<std::function<MatrixRow()>>& more,
                        const MatrixWatch& watch = {});

}  // namespace plica
