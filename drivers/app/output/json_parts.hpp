// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <nlohmann/json.hpp>
#include <plica/core/obstacles.hpp>
#include <plica/drivers/elastic/materials.hpp>
#include <string>
#include <vector>

/// JSON and text of what several results share: materials, obstacles, the machine.
namespace plica::app {

/// Returns JSON as the program writes it: indented, with an end of line. Bytes that are not UTF-8
/// become U+FFFD; names of files may have such bytes.
inline std::string json_text(const nlohmann::ordered_json& json) {
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

/// Returns a material and the parameters that it declares as text: "neo_hookean, young_modulus 20
/// kPa, poisson_ratio 0.4, density 1000 kg/m^3".
std::string material_text(const MaterialInfo& info, const MaterialOptions& material);

/// Returns a material as JSON: {"model", each parameter by its name, "density"}, in SI units.
nlohmann::ordered_json material_json(const MaterialInfo& info, const MaterialOptions& material);

/// Returns shapes and motions of the obstacles as JSON, so that a page can draw them. A
/// triangulated surface is given by its bounding box and its number of triangles.
nlohmann::ordered_json obstacles_json(const ContactOptions& contact);

/// Machine on which measurements were made.
struct StudyMachine {
  std::string cpu;
  int cores = 0;
  std::string backend;
  int threads = 0;  ///< maximum number of threads
};

/// Returns the machine on which the program runs. Needs Kokkos.
StudyMachine this_machine();

/// Returns the text of `plica --version`: version, Kokkos and its back ends, compiler, commit.
std::string version_text();

/// Returns the machine as JSON, with the compiler and version of the program that measured.
nlohmann::ordered_json machine_json(const StudyMachine& machine);

}  // namespace plica::app
