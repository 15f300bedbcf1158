// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <functional>
#include <plica/core/problem.hpp>
#include <string>
#include <vector>

namespace plica {

/// A body of the stability matrix, and what is known of its run beforehand.
struct MatrixBody {
  Problem problem;
  std::vector<Point> displacement;  ///< at the start [m]; empty: none
  /// macro step over the finest critical step; 0: the method's own
  double step = 0;
  double load_ratio = 1e-4;  ///< rho g L / E, from which gravity follows; 0: none
  /// The shape that it starts in.
  enum class Start { rest, stretched, thin, flat, turned, mirrored, random } start = Start::rest;
  double impact = 0;      ///< speed at which it strikes, over that of its waves
  bool refused = false;   ///< its step is above the limit
  bool unstable = false;  ///< and is taken all the same
  bool apart = false;     ///< its levels lie at different places

  /// About: a cantilever four times as long as thick is strained by 12 times the load ratio at
  /// rest, 24 times when it is let go.
  double strain() const { return 24 * load_ratio; }
  bool inside_out() const { return start >= Start::flat; }  ///< elements have J <= 0 at the start
  void load();                                              ///< sets gravity
};

/// 0.4 x 0.1 x 0.1 m, clamped at x = 0, of 192 tetrahedra and 24.
MatrixBody clamped_beam();

void set_young_modulus(MatrixBody& body, double pascal);
void set_young_modulus_on_earth(MatrixBody& body, double pascal);
void set_poisson_ratio(MatrixBody& body, double ratio);
void set_density(MatrixBody& body, double density);
void set_size(MatrixBody& body, double length);
void set_gravity(MatrixBody& body, double factor);
void set_step(MatrixBody& body, double over_critical);
void set_unstable_step(MatrixBody& body, double over_critical);
/// One layer of cells of level 0 is so many times thinner than it is wide.
void set_slivers(MatrixBody& body, double ratio);
void set_stretch(MatrixBody& body, double factor);
/// Across the beam, along z: 0 flattens, below 0 inverts.
void set_thickness(MatrixBody& body, double factor);
void set_random(MatrixBody& body, double seed);
/// Free, it falls flat on a plane.
void set_impact(MatrixBody& body, double speed);
/// Its outer half is stiffer.
void set_contrast(MatrixBody& body, double ratio);
void set_one_tetrahedron(MatrixBody& body, double edge);
void set_levels(MatrixBody& body, double count);
/// Level 1 lies so many lengths of the beam further along.
void set_overlap(MatrixBody& body, double lengths);

/// The outcomes that a run may have. At least one is true.
struct Expected {
  bool complete = false;     ///< it reaches its end
  bool stop = false;         ///< it is stopped with a diagnosis
  bool refuse = false;       ///< its set-up refuses
  std::string kind = {};     ///< of the diagnosis; empty: any that fits what is run
  std::string why = {};      ///< why more than one is right; empty where only one is
  std::string text() const;  ///< "completed or stopped"
};

/// One run of the matrix.
struct MatrixCase {
  std::string name;    ///< "E = 1e+10 Pa, linear"
  std::string method;  ///< as of a study
  Problem problem;     ///< complete but for its macro step
  double step = 0;     ///< that, times the critical step of its finest level (of an implicit one
                       ///< symplectic Euler's); 0: auto
  long macro_steps = 0;
  std::vector<Point> displacement;  ///< at the start [m]; empty: as the problem says
  Expected expected;
};

/// Its outcome.
struct MatrixRow {
  std::string name, method, expected;
  std::string outcome;  ///< completed | stopped: KIND | refused | not finite | no diagnosis; of an
                        ///< invariance how much differs
  bool ok = false;
  std::string detail;    ///< diagnosis or message
  std::string why = {};  ///< see Expected
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

/// Every case, from one table; the outcome that each must have follows from rules that are stated
/// there.
std::vector<MatrixCase> stability_matrix(MatrixSize size = MatrixSize::whole);

/// Every tissue and law of tissue, fibres, softening and relaxation, of linear and nodal elements;
/// the whole matrix ends with them.
std::vector<MatrixCase> tissue_cases();

/// Runs one. A state that the caller could write and that is not finite, a diagnosis that does not
/// say where, or a kind that cannot be are never what was expected.
MatrixRow run_case(const MatrixCase& one);

/// Whether turned, moved, renumbered bodies and other units of length give the same answers: a row
/// for each of them and each method.
std::vector<std::function<MatrixRow()>> invariance_cases(MatrixSize size = MatrixSize::whole);

/// Organs with tools: an irregular liver that is dropped, poked, dragged along, pierced at, grasped
/// and swung, two organs, a folded tube; by every stepper, with linear and nodal elements, nu 0.3
/// to 0.49, steps of 1 to 10 ms. Each must come to its end.
std::vector<std::function<MatrixRow()>> organ_cases(MatrixSize size = MatrixSize::whole);

/// Called after every row with how many there will be; false stops it.
using MatrixWatch = std::function<bool(const MatrixResult&, std::size_t)>;

MatrixResult run_matrix(const std::vector<MatrixCase>& cases,
                        const std::vector<std::function<MatrixRow()>>& more,
                        const MatrixWatch& watch = {});

}  // namespace plica
