// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <functional>
#include <memory>
#include <plica/drivers/solver/contact.hpp>

namespace plica {

/// Contact in a step of the hierarchical inverse mass: the accelerations by contact and friction, implicit in themselves.
/// Three applications of A, on the device only where something touches.
template <class B>
class ContactResponse {
 public:
  using Exec = typename B::Exec;
  using Real = typename B::Real;
  /// answer = A force, where `count` is above 0; force stays.
  using Apply = std::function<void(const Vectors<B>& force, const Vectors<B>& answer, const Doubles<B>& count)>;

  ContactResponse(std::shared_ptr<const Contact<B>> contact, int vertices);

  /// Into answer(): the accelerations to add to the smooth ones of a state at `time`, step t [s].
  void resolve(const Exec& exec, const Level<B>& level, double time, double t, const Vectors<B>& smooth,
               const Apply& apply) const;
  const Vectors<B>& answer() const { return answer_; }
  const Vectors<B>& force() const { return force_; }  ///< of the vertices, which has that answer [N]
  /// [1]: how many points touch; 0: answer() is not to be looked at.
  const Doubles<B>& count() const { return points_.count; }
  std::size_t bytes() const;

 private:
  std::shared_ptr<const Contact<B>> contact_;
  TouchingPoints<B> points_;
  BlockSums<B> blocks_;
  Vectors<B> force_, answer_;

  void respond(const Exec& exec, const Level<B>& level, const Apply& apply) const;
};

}  // namespace plica
