// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <cmath>
#include <plica/drivers/app/output/history.hpp>
#include <plica/drivers/solver/set_up/lumped_masses.hpp>

namespace plica::app {

std::vector<double> vertex_masses(const Body& body, int level) {
  const TetMesh& mesh = body.levels[static_cast<std::size_t>(level)];
  return lumped_masses(mesh, region_densities(body, mesh));
}

namespace {

constexpr const char* head =
    "time,kinetic_energy,elastic_energy,potential_energy,contact_energy,total_energy,"
    "com_x,com_y,com_z,max_speed,rms_speed";

}  // namespace

History::History(const std::filesystem::path& file, std::vector<double> masses, bool retries,
                 std::optional<std::uint64_t> kept)
    : file_(kept ? GrowingFile(file, *kept) : GrowingFile(file, std::string(head) + (retries ? ",halvings\n" : "\n"))),
      masses_(std::move(masses)),
      retries_(retries) {}

void History::write(const Snapshot& s) {
  double mass = 0, max_square = 0, sum_square = 0;
  Point centre = Point::Zero();
  for (std::size_t i = 0; i < masses_.size(); ++i) {
    const double square = s.velocities[i].squaredNorm();
    mass += masses_[i];
    centre += masses_[i] * s.positions[i];
    sum_square += masses_[i] * square;
    max_square = std::max(max_square, square);
  }
  centre /= mass;
  const Energies& e = s.energies;
  file_.add(fmt::format("{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}{}\n", s.time,
                        e.kinetic, e.elastic, e.potential, e.contact, e.total(), centre.x(), centre.y(), centre.z(),
                        std::sqrt(max_square), std::sqrt(sum_square / mass),
                        retries_ ? fmt::format(",{}", s.halvings) : std::string{}));
}

}  // namespace plica::app
