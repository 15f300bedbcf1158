// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <charconv>
#include <fstream>
#include <nlohmann/json.hpp>
#include <plica/core/text.hpp>
#include <plica/drivers/app/output/checkpoint.hpp>
#include <plica/drivers/app/output/columns.hpp>
#include <plica/drivers/app/output/cycle_choice.hpp>
#include <plica/drivers/app/output/write_file.hpp>
#include <plica/drivers/app/scene/tree.hpp>
#include <sstream>

namespace plica::app {
namespace {

using Json = nlohmann::ordered_json;
constexpr const char* checkpoint_title = "plica checkpoint ";
constexpr int version_written = 17;

// Returns a path as JSON: a text if it is UTF-8, else a list of the values of its bytes
Json path_json(const std::string& path) {
  if (valid_utf8(path) == path) return path;
  return std::vector<unsigned char>(path.begin(), path.end());
}
std::string path_of(const Json& json) {
  if (json.is_string()) return json.get<std::string>();
  const auto bytes = json.get<std::vector<unsigned char>>();
  return {bytes.begin(), bytes.end()};
}

// Returns the columns of a path
Column<Checkpoint> path_column(const std::string& name, std::string Checkpoint::*path) {
  return {name, [=](const Checkpoint& c) { return path_json(c.*path); },
          [=](const Json& json, Checkpoint& c) { c.*path = path_of(json); }};
}

Column<Checkpoint> interval_column(const std::string& name, Interval Checkpoint::*interval) {
  return {name,
          [=](const Checkpoint& c) {
            return Json{(c.*interval).time, (c.*interval).steps};
          },
          [=](const Json& json, Checkpoint& c) {
            c.*interval = {json.at(0).get<double>(), json.at(1).get<long>()};
          }};
}

// All but the state; the scene is read after its path
const Table<Checkpoint> checkpoint_columns = {
    path_column("scene_file", &Checkpoint::scene_file),
    path_column("scene_path", &Checkpoint::scene_path),
    {"scene", [](const Checkpoint& c) { return json_of(c.scene); },
     [](const Json& json, Checkpoint& c) { c.scene = tree_of(json, c.scene_path); }},
    {"meshes", &Checkpoint::meshes}, {"precision", &Checkpoint::precision},
    {"backend", &Checkpoint::backend}, {"program", &Checkpoint::program},
    interval_column("every", &Checkpoint::every),
    interval_column("frame_every", &Checkpoint::frame_every),
    {"macro_steps", &Checkpoint::macro_steps}, {"wall_time", &Checkpoint::wall_time},
    {"stages", &Checkpoint::stages},
    {"choice", [](const Checkpoint& c) { return choice_json(c.choice); },
     [](const Json& json, Checkpoint& c) { c.choice = choice_of(json); }},
    {"energy", &Checkpoint::energy}, {"inside_out", &Checkpoint::inside_out},
    {"depth", &Checkpoint::depth}, {"frame_times", [](auto& c) -> auto& {return c.files.frame_times;
}  // namespace
}  // namespace plica::app
, {"history_bytes", [](auto& c) -> auto& {return c.files.history_bytes;
}
}
, {
  "probe_bytes", [](auto& c) -> auto& { return c.files.probe_bytes; }
}
}
;

std::uint64_t digest_of(const std::string& text) {
  Digest digest;
  digest.add(text.data(), text.size());
  return digest.value();
}

// Returns the next number of the text, up to a blank or the end of the line. Moves `at` past it
std::uint64_t next_number(const std::string& text, std::size_t& at, int base,
                          const SourceLocation& where) {
  std::uint64_t value = 0;
  const auto [rest, error] =
      std::from_chars(text.data() + at, text.data() + text.size(), value, base);
  const bool ends = rest != text.data() + text.size() && (*rest == ' ' || *rest == '\n');
  if (error != std::errc{} || !ends)
    throw InputError("the checkpoint is damaged: its head cannot be read", where);
  at = static_cast<std::size_t>(rest - text.data()) + 1;
  return value;
}

}  // namespace

std::uint64_t mesh_digest(const Body& body) {
  Digest digest;
  const auto add_points = [&digest](const std::vector<Point>& points) {
    for (const Point& p : points) digest.add(p.data(), 3 * sizeof(double));
  };
  for (const TetMesh& mesh : body.levels) {
    add_points(mesh.vertices);
    digest.add(mesh.tets);
    digest.add(mesh.region);
    digest.add(mesh.filled);
    if (!mesh.piece.empty()) {
      digest.add(mesh.piece);
      digest.add(mesh.followers.vertex);
      digest.add(mesh.followers.of);
      digest.add(mesh.followers.weight);
    }
    for (const std::string& name : mesh.region_names) digest.add(name);
    for (const auto& [name, vertices] : mesh.vertex_sets) digest.add(name), digest.add(vertices);
    for (const auto& [name, set] : mesh.triangle_sets) digest.add(name), digest.add(set);
    for (const auto& [name, vectors] : mesh.tet_vectors) digest.add(name), add_points(vectors);
  }
  if (body.surface) {
    add_points(body.surface->vertices);
    digest.add(body.surface->triangles);
  }
  return digest.value();
}

void write_checkpoint(const std::filesystem::path& folder, const Checkpoint& checkpoint) {
  const std::string header = checkpoint_columns.json(checkpoint).dump();
  std::string body = header;
  body.append(checkpoint.state.bytes.begin(), checkpoint.state.bytes.end());
  const std::string head = fmt::format("{}{}\n{} {} {:016x}\n", checkpoint_title, version_written,
                                       header.size(), body.size() - header.size(), digest_of(body));
  write_file(folder / "checkpoint.bin", head + body, Durable::yes);
}

Checkpoint read_checkpoint(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "checkpoint.bin";
  const SourceLocation where{file.string()};
  if (!std::filesystem::exists(file))
    throw InputError(
        "there is no checkpoint to resume from; a run writes one only with --checkpoint", where);
  std::ostringstream read;
  read << std::ifstream(file, std::ios::binary).rdbuf();
  const std::string text = read.str();
  if (!text.starts_with(checkpoint_title))
    throw InputError("this is no checkpoint, or a damaged one", where);
  std::size_t at = std::string_view(checkpoint_title).size();
  if (const auto version = next_number(text, at, 10, where); version != version_written)
    throw InputError(fmt::format("the checkpoint is of version {}; this program reads {}", version,
                                 version_written),
                     where);
  const std::uint64_t header = next_number(text, at, 10, where),
                      state = next_number(text, at, 10, where),
                      digest = next_number(text, at, 16, where), left = text.size() - at;
  if (header > left || state != left - header)
    throw InputError(fmt::format("the checkpoint is damaged: {} bytes after its head, {} expected",
                                 left, header + state),
                     where);
  const std::string body = text.substr(at);
  if (digest_of(body) != digest)
    throw InputError("the checkpoint is damaged: its checksum is wrong", where);
  try {
    Checkpoint checkpoint;
    checkpoint_columns.read(
        Json::parse(body.begin(), body.begin() + static_cast<std::ptrdiff_t>(header)), checkpoint);
    checkpoint.state.bytes.assign(body.begin() + static_cast<std::ptrdiff_t>(header), body.end());
    return checkpoint;
  } catch (const Json::exception& error) {
    throw InputError(std::string("the checkpoint is damaged: ") + error.what(), where);
  }
}

}  // namespace plica::app
