// SPDX-License-Identifier: BSD-3-Clause
#include <plica/drivers/contact/obstacle_of.hpp>

namespace plica {

#define PLICA_INSTANTIATE(Exec)                                           \
  template std::unique_ptr<Obstacle<Backend<float, Exec>>> make_obstacle( \
      const ObstacleOptions&, const DepthWatch<Backend<float, Exec>>&,    \
      const Doubles<Backend<float, Exec>>&, int, double);
#ifndef PLICA_WITHOUT_FLOAT
PLICA_FOR_EACH_SPACE(PLICA_INSTANTIATE)
#endif

}  // namespace plica
