// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <plica/drivers/app/output/checkpoint.hpp>
#include <plica/drivers/app/output/study_choice.hpp>
#include <plica/drivers/app/output/study_files.hpp>
#include <plica/drivers/app/output/truth_report.hpp>
#include <plica/drivers/app/output/write_file.hpp>
#include <plica/drivers/app/scene/tree.hpp>
#include <plica/drivers/elastic/elements.hpp>
#include <plica/version.hpp>
#include <sstream>

namespace plica::app {

using Json = nlohmann::ordered_json;

namespace {

constexpr int format_version = 2;

std::uint64_t digest_of_states(const std::string& bytes) {
  Digest digest;
  digest.add(bytes);
  return digest.value();
}

void append(std::string& bytes, const Trajectory& trajectory) {
  const auto add = [&bytes](const double* from, std::size_t count) {
    bytes.append(reinterpret_cast<const char*>(from), count * sizeof(double));
  };
  add(trajectory.times.data(), trajectory.times.size());
  for (const auto* fields : {&trajectory.u, &trajectory.v})
    for (const auto& field : *fields)
      for (const Point& p : field) add(p.data(), 3);
}

Trajectory take(const std::string& bytes, std::size_t& at, std::size_t samples,
                std::size_t vertices) {
  const auto next = [&](double* to, std::size_t count) {
    std::memcpy(to, bytes.data() + at, count * sizeof(double));
    at += count * sizeof(double);
  };
  Trajectory trajectory;
  trajectory.times.resize(samples);
  next(trajectory.times.data(), samples);
  for (auto* fields : {&trajectory.u, &trajectory.v}) {
    fields->assign(samples, std::vector<Point>(vertices));
    for (auto& field : *fields)
      for (Point& p : field) next(p.data(), 3);
  }
  return trajectory;
}

// Columns of the reference without its motions
const Table<StudyReference> reference_columns = {
    {"method", &StudyReference::method},
    {"macro_step", &StudyReference::macro_step},
    {"critical_step", &StudyReference::critical_step},
    {"own_error", &StudyReference::own_error},
    {"own_error_velocity", &StudyReference::own_error_velocity},
    {"wall_time", &StudyReference::wall_time},
    {"seconds_per_evaluation", &StudyReference::seconds_per_evaluation}};

}  // namespace

std::string reference_bytes(const StudyReference& r, std::uint64_t digest) {
  std::string states;
  append(states, r.trajectory);
  if (r.finer) append(states, *r.finer);
  if (r.truth) append(states, r.probes);
  for (const MeshReference& mesh : r.meshes) append(states, mesh.trajectory);
  Json head = {
      {"plica_reference", format_version}, {"of", digest}, {"states", digest_of_states(states)}};
  head.update(reference_columns.json(r));
  head.update({{"space_error", r.space_error.value_or(0)},
               {"samples", r.trajectory.times.size()},
               {"vertices", r.trajectory.u.front().size()},
               {"finer", r.finer.has_value()},
               {"truth", r.truth ? truth_columns().json(*r.truth) : Json()},
               {"meshes", mesh_columns().json(r.meshes)},
               {"probes", r.truth ? r.probes.u.front().size() : 0}});
  return head.dump() + "\n" + states;
}

std::optional<StudyReference> parse_reference(const std::string& bytes, std::uint64_t digest) try {
  const std::size_t line = bytes.find('\n');
  if (line == std::string::npos) return {};
  const Json head = Json::parse(bytes.substr(0, line));
  const std::string states = bytes.substr(line + 1);
  if (head.at("plica_reference") != format_version || head.at("of") != digest ||
      head.at("states") != digest_of_states(states))
    return {};
  StudyReference r;
  reference_columns.read(head, r);
  const auto samples = head.at("samples").get<std::size_t>(),
             vertices = head.at("vertices").get<std::size_t>();
  const bool finer = head.at("finer").get<bool>(), truth = !head.at("truth").is_null();
  mesh_columns().read(head.at("meshes"), r.meshes);
  const auto size_of = [&](std::size_t points) {
    return samples * (1 + 6 * points) * sizeof(double);
  };
  const auto probes = head.at("probes").get<std::size_t>();
  if (states.size() !=
      (1 + (finer ? 1U : 0U) + r.meshes.size()) * size_of(vertices) + (truth ? size_of(probes) : 0))
    return {};
  std::size_t at = 0;
  r.trajectory = take(states, at, samples, vertices);
  if (finer)
    r.finer = take(states, at, samples, vertices),
    r.space_error = head.at("space_error").get<double>();
  if (truth)
    truth_columns().read(head.at("truth"), r.truth.emplace()),
        r.probes = take(states, at, samples, probes);
  for (MeshReference& mesh : r.meshes) mesh.trajectory = take(states, at, samples, vertices);
  return r;
} catch (const Json::exception&) {
  return {};
}

namespace {

// Returns the scene as JSON, without some keys of the top level
std::string said_without(const Tree& source, const std::vector<std::string>& keys) {
  Tree tree = source;
  std::erase_if(tree.items,
                [&](const Tree& item) { return std::ranges::find(keys, item.key) != keys.end(); });
  return json_of(tree).dump();
}

void add_tools(Digest& digest, const Problem& problem) {
  for (const ObstacleOptions& obstacle : problem.contact.obstacles)
    if (const auto* tool = std::any_cast<SurfaceOptions>(&obstacle.shape))
      for (const Point& p : tool->surface.vertices) digest.add(p.data(), 3 * sizeof(double));
}

// Returns a digest of everything that the motion of the finest level alone depends on
std::uint64_t reference_digest(const Scene& scene, const StudyOptions& o) {
  Digest digest;
  digest.add(said_without(scene.source, {"name", "output", "study", "integration"}));
  for (std::size_t i = 0; i < scene.problem.body.levels.size(); ++i)
    digest.add(std::string(name_of(element_of(scene.problem.body, i))));
  digest.add(fmt::format("{} {} {} {} {} {}", mesh_digest(scene.problem.body), o.samples,
                         o.reference_integrator, o.reference_step, o.reference_error,
                         o.finer.has_value()));
  if (o.truth) {
    digest.add(
        fmt::format("truth {} {}", o.truth->refinements.value_or(0), o.truth->jitter.value_or(0)));
    for (const auto& [name, p] : o.probes)
      digest.add(fmt::format("{} {} {} {}", name, p.x(), p.y(), p.z()));
  }
  add_tools(digest, scene.problem);
  return digest.value();
}

// Returns a digest of everything that the rows depend on. Times depend on program and machine too
std::uint64_t study_digest(const Scene& scene, const StudyOptions& o, const StudyMachine& machine,
                           std::uint64_t reference) {
  Digest digest;
  digest.add(said_without(scene.source, {"name", "output", "study"}));
  const Tree* section = scene.source.find("study");
  if (const Tree* variants = section ? section->find("variants") : nullptr)
    digest.add(json_of(*variants).dump());
  for (const auto& [name, p] : o.probes)
    digest.add(fmt::format("{} {} {} {}", name, p.x(), p.y(), p.z()));
  digest.add(fmt::format("{} {} {} {} {} {} {} {}", reference, o.timed_runs, machine.cpu,
                         machine.backend, machine.threads, version(), git_revision(), compiler()));
  return digest.value();
}

std::string content_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

}  // namespace

StudyFiles::StudyFiles(const Scene& scene, const StudyOptions& options,
                       const std::filesystem::path& folder)
    : folder_(folder),
      machine_(this_machine()),
      reference_digest_(reference_digest(scene, options)) {
  head_.scene = scene.file, head_.name = scene.name;
  head_.duration = options.duration, head_.samples = options.samples;
  for (const TetMesh& mesh : scene.problem.body.levels) head_.tets.push_back(mesh.tets.size());
  head_.levels = level_entries(scene.source);
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

bool StudyFiles::holds_another() const {
  return holds_other_rows(content_of(folder_ / "study.json"), head_.digest);
}

std::vector<FileBytes> StudyFiles::texts(const StudyResult& result, const std::string& status,
                                         const std::string& stopped) const {
  return {{folder_ / "study.json", study_json(head_, machine_, result, status, stopped)},
          {folder_ / "study.csv", study_csv(result.rows)}};
}

void StudyFiles::write_reference(const StudyReference& reference) const {
  write_file(folder_ / "reference.bin", reference_bytes(reference, reference_digest_));
}

}  // namespace plica::app
