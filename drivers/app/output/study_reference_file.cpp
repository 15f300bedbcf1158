// SPDX-License-Identifier: BSD-3-Clause
#include <cstring>
#include <nlohmann/json.hpp>
#include <plica/drivers/app/output/digest.hpp>
#include <plica/drivers/app/output/study_reference_file.hpp>

namespace plica::app {

using Json = nlohmann::ordered_json;

namespace {

constexpr int format_version = 1;

std::uint64_t digest_of(const std::string& bytes) {
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

Trajectory take(const std::string& bytes, std::size_t& at, std::size_t samples, std::size_t vertices) {
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

}  // namespace

std::string reference_bytes(const StudyReference& r, std::uint64_t digest) {
  std::string states;
  append(states, r.trajectory);
  if (r.finer) append(states, *r.finer);
  const Json head = {{"plica_reference", format_version},
                     {"of", digest},
                     {"states", digest_of(states)},
                     {"method", r.method},
                     {"macro_step", r.macro_step},
                     {"critical_step", r.critical_step},
                     {"own_error", r.own_error},
                     {"own_error_velocity", r.own_error_velocity},
                     {"wall_time", r.wall_time},
                     {"seconds_per_evaluation", r.seconds_per_evaluation},
                     {"space_error", r.space_error.value_or(0)},
                     {"samples", r.trajectory.times.size()},
                     {"vertices", r.trajectory.u.front().size()},
                     {"finer", r.finer.has_value()}};
  return head.dump() + "\n" + states;
}

std::optional<StudyReference> parse_reference(const std::string& bytes, std::uint64_t digest) try {
  const std::size_t line = bytes.find('\n');
  if (line == std::string::npos) return {};
  const Json head = Json::parse(bytes.substr(0, line));
  const std::string states = bytes.substr(line + 1);
  if (head.at("plica_reference") != format_version || head.at("of") != digest || head.at("states") != digest_of(states))
    return {};
  StudyReference r;
  head.at("method").get_to(r.method);
  head.at("macro_step").get_to(r.macro_step);
  head.at("critical_step").get_to(r.critical_step);
  head.at("own_error").get_to(r.own_error);
  head.at("own_error_velocity").get_to(r.own_error_velocity);
  head.at("wall_time").get_to(r.wall_time);
  head.at("seconds_per_evaluation").get_to(r.seconds_per_evaluation);
  const auto samples = head.at("samples").get<std::size_t>(), vertices = head.at("vertices").get<std::size_t>();
  const bool finer = head.at("finer").get<bool>();
  if (states.size() != (finer ? 2U : 1U) * samples * (1 + 6 * vertices) * sizeof(double)) return {};
  std::size_t at = 0;
  r.trajectory = take(states, at, samples, vertices);
  if (finer) r.finer = take(states, at, samples, vertices), r.space_error = head.at("space_error").get<double>();
  return r;
} catch (const Json::exception&) {
  return {};
}

}  // namespace plica::app
