// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <plica/drivers/app/output/checkpoint.hpp>
#include <plica/drivers/app/output/digest.hpp>
#include <plica/drivers/app/output/study_files.hpp>
#include <plica/drivers/app/output/study_reference_file.hpp>
#include <plica/drivers/app/scene/tree_json.hpp>
#include <plica/version.hpp>
#include <sstream>

namespace plica::app {
namespace {

// What a scene says but for some keys of its top level
std::string said_without(const Tree& source, const std::vector<std::string>& keys) {
  Tree tree = source;
  std::erase_if(tree.items, [&](const Tree& item) { return std::ranges::find(keys, item.key) != keys.end(); });
  return json_of(tree).dump();
}

void add_tools(Digest& digest, const Problem& problem) {
  for (const ObstacleOptions& obstacle : problem.contact.obstacles)
    if (const auto* tool = std::get_if<SurfaceOptions>(&obstacle.shape))
      for (const Point& p : tool->surface.vertices) digest.add(p.data(), 3 * sizeof(double));
}

// What the motion of the finest level alone depends on
std::uint64_t reference_digest(const Scene& scene, const StudyOptions& o) {
  Digest digest;
  digest.add(said_without(scene.source, {"name", "output", "study", "integration"}));
  digest.add(fmt::format("{} {} {} {} {} {}", mesh_digest(scene.problem.body), o.samples, o.reference_integrator,
                         o.reference_step, o.reference_error, o.finer.has_value()));
  add_tools(digest, scene.problem);
  return digest.value();
}

// What rows depend on beside that: times are those of one program on one machine
std::uint64_t study_digest(const Scene& scene, const StudyOptions& o, const StudyMachine& machine,
                           std::uint64_t reference) {
  Digest digest;
  digest.add(said_without(scene.source, {"name", "output", "study"}));
  const Tree* section = scene.source.find("study");
  if (const Tree* variants = section ? section->find("variants") : nullptr) digest.add(json_of(*variants).dump());
  for (const auto& [name, p] : o.probes) digest.add(fmt::format("{} {} {} {}", name, p.x(), p.y(), p.z()));
  digest.add(fmt::format("{} {} {} {} {} {} {} {}", reference, o.timed_runs, machine.cpu, machine.backend,
                         machine.threads, version(), git_revision(), compiler()));
  return digest.value();
}

std::string content_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

}  // namespace

StudyFiles::StudyFiles(const Scene& scene, const StudyOptions& options, const std::filesystem::path& folder)
    : folder_(folder), machine_(this_machine()), reference_digest_(reference_digest(scene, options)) {
  head_.scene = scene.file, head_.name = scene.name;
  head_.duration = options.duration, head_.samples = options.samples;
  for (const TetMesh& mesh : scene.problem.body.levels) head_.tets.push_back(mesh.tets.size());
  head_.digest = fmt::format("{:016x}", study_digest(scene, options, machine_, reference_digest_));
}

StudyResult StudyFiles::read() const {
  StudyResult before;
  if (auto reference = parse_reference(content_of(folder_ / "reference.bin"), reference_digest_)) {
    before.reference = std::move(*reference);
    before.rows = rows_of_study(content_of(folder_ / "study.json"), head_.digest);
  }
  return before;
}

void StudyFiles::write(const StudyResult& result, const std::string& status) const {
  write_file(folder_ / "study.json", study_json(head_, machine_, result, status));
  write_file(folder_ / "study.csv", study_csv(result.rows));
}

void StudyFiles::write_reference(const StudyReference& reference) const {
  write_file(folder_ / "reference.bin", reference_bytes(reference, reference_digest_));
}

}  // namespace plica::app
