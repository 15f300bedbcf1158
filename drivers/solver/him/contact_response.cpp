// SPDX-License-Identifier: BSD-3-Clause
#include <plica/drivers/solver/him/contact_response.hpp>
#include <plica/kernels/contact/contact_kernels.hpp>

namespace plica {

namespace {

template <class B>
struct ZeroVectors {
  Vectors<B> x;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    for (int k = 0; k < 3; ++k) x(a, k) = 0;
  }
};

}  // namespace

template <class B>
ContactResponse<B>::ContactResponse(std::shared_ptr<const Contact<B>> contact, int vertices)
    : contact_(std::move(contact)),
      blocks_(contact_->points()),
      force_(zeros<Vectors<B>>("plica::touching.vertex_force", vertices)),
      answer_(zeros<Vectors<B>>("plica::touching.answer", vertices)) {
  const auto n = static_cast<std::size_t>(contact_->points());
  points_.normal = zeros<Vectors<B>>("plica::touching.normal", n);
  points_.velocity = zeros<Vectors<B>>("plica::touching.velocity", n);
  points_.force = zeros<Vectors<B>>("plica::touching.force", n);
  points_.depth = zeros<Scalars<B>>("plica::touching.depth", n);
  points_.tangential = zeros<Scalars<B>>("plica::touching.tangential", n);
  points_.friction = zeros<Scalars<B>>("plica::touching.friction", n);
  points_.mobility = zeros<Scalars<B>>("plica::touching.mobility", n);
  points_.count = zeros<Doubles<B>>("plica::touching.count", 1);
}

template <class B>
void ContactResponse<B>::respond(const Exec& exec, const Level<B>& level, const Apply& apply) const {
  where_touching<B>(exec, points_.count, "plica::touching_zero", level.model.vertices, ZeroVectors<B>{force_});
  where_touching<B>(exec, points_.count, "plica::touching_scatter", level.surface.touched,
                    ScatterToVertices<B>{level.surface, points_.force, force_});
  apply(force_, answer_, points_.count);
}

template <class B>
void ContactResponse<B>::resolve(const Exec& exec, const Level<B>& level, double time, double t,
                                 const Vectors<B>& smooth, const Apply& apply) const {
  const int n = level.surface.points;
  contact_->find(exec, level, level.state, time, points_);
  const TouchLaw<B> law{level.surface,
                        points_,
                        smooth,
                        answer_,
                        static_cast<Real>(t),
                        static_cast<Real>(contact_->stiffness()),
                        static_cast<Real>(contact_->normal_damping())};
  reduce<B, 1>(exec, "plica::touching_start", n, StartTouching<B>{law}, blocks_, points_.count);
  for (const bool first : {true, false}) {
    respond(exec, level, apply);
    where_touching<B>(exec, points_.count, "plica::touching_sweep", n, SweepTouching<B>{law, first});
  }
  respond(exec, level, apply);
}

template <class B>
std::size_t ContactResponse<B>::bytes() const {
  const std::size_t n = points_.depth.extent(0);
  return (13 * n + force_.span() + answer_.span()) * sizeof(Real);
}

#define PLICA_INSTANTIATE(Real, Exec) template class ContactResponse<Backend<Real, Exec>>;
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
