// SPDX-License-Identifier: BSD-3-Clause
#include <plica/core/error.hpp>
#include <plica/core/to_device.hpp>
#include <plica/drivers/body/initial_state.hpp>
#include <plica/drivers/elastic/materials.hpp>
#include <plica/drivers/run/deform_start.hpp>
#include <plica/drivers/run/whole.hpp>
#include <plica/kernels/loads/boundary_conditions.hpp>

namespace plica {

template <class B>
void deform_start(const Body& body, const TetMesh& mesh, const std::vector<char>& given,
                  const Level<B>& level) {
  std::vector<Point> u = initial_displacement(body.initial, mesh, bounding_box(mesh.vertices));
  const std::vector<Point> present = whole_field<B>(level, level.state.u);
  for (std::size_t a = 0; a < u.size(); ++a)
    if (given[a]) u[a] = present[a];
  if (!allows_inversion(body.material))
    if (const std::string inverted = inverted_at_start(mesh, u); !inverted.empty())
      throw InputError("body.initial: " + inverted +
                       ", which this material may not; expected "
                       "body.material.allow_inversion: true, or a start without inverted elements");
  if (level.ranks) u = level.ranks->part.local(u);
  copy(level.exec(), level.state.u, to_device<Vectors<B>>("start", rows<typename B::Real>(u)));
  hold_sliding(level.exec(), level, level.state.u);
  follow_masters(level.exec(), level.model, level.state.u);
}

#define PLICA_INSTANTIATE(Real, Exec)                                               \
  template void deform_start(const Body&, const TetMesh&, const std::vector<char>&, \
                             const Level<Backend<Real, Exec>>&);
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
