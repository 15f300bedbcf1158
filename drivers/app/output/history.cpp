// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <cmath>
#include <plica/drivers/app/output/history.hpp>

namespace plica::app {

std::vector<double> vertex_masses(const Body& body, int level) {
  const TetMesh& mesh = body.levels[static_cast<std::size_t>(level)];
  std::vector<double> densities;
  for (const std::string& name : mesh.region_names) {
    const auto own = body.regions.find(name);
    densities.push_back(own == body.regions.end() ? body.material.density
                                                  : own->second.density.value_or(body.material.density));
  }
  std::vector<double> masses(mesh.vertices.size(), 0.0);
  for (std::size_t e = 0; e < mesh.tets.size(); ++e) {
    const auto corner = [&](std::size_t k) { return static_cast<std::size_t>(mesh.tets[e][k]); };
    const double volume = tet_volume(mesh.vertices[corner(0)], mesh.vertices[corner(1)], mesh.vertices[corner(2)],
                                     mesh.vertices[corner(3)]);
    const double density =
        mesh.region.empty() ? body.material.density : densities[static_cast<std::size_t>(mesh.region[e])];
    for (std::size_t k = 0; k < 4; ++k) masses[corner(k)] += density * volume / 4;
  }
  return masses;
}

namespace {

constexpr const char* head =
    "time,kinetic_energy,elastic_energy,potential_energy,contact_energy,total_energy,"
    "com_x,com_y,com_z,max_speed,rms_speed\n";

}  // namespace

History::History(const std::filesystem::path& file, std::vector<double> masses, std::optional<std::uint64_t> kept)
    : file_(kept ? GrowingFile(file, *kept) : GrowingFile(file, head)), masses_(std::move(masses)) {}

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
  file_.add(fmt::format("{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}\n", s.time,
                        e.kinetic, e.elastic, e.potential, e.contact, e.total(), centre.x(), centre.y(), centre.z(),
                        std::sqrt(max_square), std::sqrt(sum_square / mass)));
}

}  // namespace plica::app
