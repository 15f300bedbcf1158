// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <functional>
#include <limits>
#include <memory>
#include <plica/core/implicit_weights.hpp>
#include <plica/core/matrices.hpp>
#include <plica/drivers/solver/contact.hpp>
#include <plica/drivers/solver/state_archive.hpp>

namespace plica {

template <class B>
class PairSearch;
template <class B>
struct TouchLaw;
template <class B>
struct LineariseTouching;

/// Contact of one level in steps that take it implicitly: the forces on its surface points, and what obstacles do to it. Kernels
/// alone, which the device leaves out where nothing touches.
template <class B>
class ContactResponse {
 public:
  using Exec = typename B::Exec;
  using Real = typename B::Real;
  /// Answers the points' forces by accelerations of the vertices, where `count` is above 0.
  using Respond = std::function<void()>;

  ContactResponse() = default;
  ContactResponse(std::shared_ptr<const Contact<B>> contact, int vertices, bool implicit);

  /// f += contact's forces on a state at `time`, which f are all other forces on; A is the inverse of the lumped masses.
  void add_forces(const Exec& exec, const Level<B>& level, const State<B>& state, double time, const ContactStep& step,
                  const Vectors<B>& f);
  /// The forces on the points, for any other A: `smooth` are the accelerations without contact, respond() makes those by the points'
  /// last forces, in `answer`.
  void resolve(const Exec& exec, const Level<B>& level, const State<B>& state, double time, const ContactStep& step,
               const Vectors<B>& smooth, const Vectors<B>& answer, const Respond& respond) const;

  /// Of which part of a macro step the next ones are: a shorter step takes the forces that a whole one would. Sweeps leave a contact softer
  /// the longer the step, so that in a short one overlap that was at rest would be pushed out at once.
  void set_part(double part) { part_ = part; }

  /// The impulse of each obstacle: forgotten, and the last forces times `weight` [s] added to it.
  void forget_impulse(const Exec& exec) const;
  void add_impulse(const Exec& exec, const Level<B>& level, const State<B>& state, double time, double weight) const;
  const Doubles<B>& impulse() const { return impulse_; }  ///< [6 obstacles, then bodies] N s and N m s
  /// Stored in all contact of the level's state [J]. Waits.
  double energy(const Exec& exec, const Level<B>& level, double time) const;
  /// See Simulation::contact_depths().
  std::vector<double> depths(const Exec& exec, const Level<B>& level, double time) const;

  // Of implicit levels, see kernels/contact/linearised.hpp:

  /// f += the forces of a stage on a state, linearised about it, with contact `ahead` of it [s]
  void linearise(const Exec& exec, const Level<B>& level, const State<B>& state, double time, const ImplicitWeights&,
                 double ahead, const Vectors<B>& f);
  /// Linearised about where a change of velocity leads to: the same places touch, by the same normals. r, what that change has left of the
  /// system's right side, then is what is left with contact as it is there.
  void move_linearised(const Exec& exec, const Level<B>& level, const Vectors<B>& change, const Vectors<B>& r);
  /// q += W^T C W p; `beside`: of what add_matrix() leaves out alone
  void add_product(const Exec& exec, const Level<B>& level, const Vectors<B>& p, bool beside,
                   const Vectors<B>& q) const;
  /// diagonal += its vertex blocks, likewise
  void add_diagonal(const Exec& exec, const Level<B>& level, bool beside, const Blocks<B>& diagonal) const;
  /// A += scale W^T C W, of points that touch obstacles
  void add_matrix(const Exec& exec, const Level<B>& level, double scale, const BlockMatrix<B>& A) const;

  const TouchingPoints<B>& points() const { return points_; }
  std::size_t bytes() const;
  /// What a step takes from the last: forgotten, or saved.
  /// @{
  void forget(const Exec& exec) const { fill(exec, points_.faces.kept, Real(0)); }
  void persist(StateArchive<B>& archive, const std::string& name) {
    archive.field(name + "places on faces", points_.faces.kept);
  }
  /// @}

 private:
  std::shared_ptr<const Contact<B>> contact_;
  TouchingPoints<B> points_;                     ///< `span`: of the last linearisation
  std::shared_ptr<const PairSearch<B>> search_;  ///< with pairs
  BlockSums<B> blocks_;
  Vectors<B> smooth_, answer_;  ///< of the vertices, on explicit levels
  Indices<B> reached_;          ///< of the touched ones, by contact in the last step
  Doubles<B> sums_, impulse_;
  ImplicitWeights weights_;  ///< of the last linearisation
  double ahead_ = 0, part_ = 1;

  void solve(const Exec& exec, const Level<B>& level, const State<B>& state, double time, const ContactStep& step,
             TouchLaw<B> law, const Respond& respond) const;
  void find(const Exec& exec, const Level<B>& level, const State<B>& state, double time, double ahead,
            const TouchingPoints<B>& points) const;
  /// They look at obstacles along the nearest normal, however far that is.
  TouchingPoints<B> all_points() const {
    TouchingPoints<B> points = points_;
    points.reach = std::numeric_limits<Real>::max();
    return points;
  }
  void sum_up(const Exec& exec, bool bounding = false) const;
  LineariseTouching<B> last_law() const;
  void scatter(const Exec& exec, const Level<B>& level, const Vectors<B>& f, const Indices<B>& reached = {}) const;
};

}  // namespace plica
