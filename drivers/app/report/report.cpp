// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <plica/core/error.hpp>
#include <plica/drivers/app/report/frames_of_cuts.hpp>
#include <plica/drivers/app/report/page.hpp>
#include <plica/drivers/app/report/read_files.hpp>
#include <plica/drivers/app/report/report.hpp>
#include <plica/drivers/app/report/surface_animation.hpp>

namespace plica::app {

using Json = nlohmann::ordered_json;

namespace {

constexpr std::size_t most_rows = 2000;  // maximum number of rows of a table on the page

// Returns whether a file exists that may be seen
bool is_seen(const std::filesystem::path& file) {
  std::error_code ignored;
  return std::filesystem::exists(file, ignored);
}
bool holds_run(const std::filesystem::path& folder) {
  return std::ranges::any_of(std::array{"frames.pvd", "summary.json", "history.csv"},
                             [&](const char* file) { return is_seen(folder / file); });
}
bool holds_study(const std::filesystem::path& folder) { return is_seen(folder / "study.json"); }

// Returns the names of the subfolders that hold a run or a study, sorted
std::vector<std::string> reportable_in(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored))
    if (holds_run(entry.path()) || holds_study(entry.path()))
      names.push_back(entry.path().filename().string());
  std::ranges::sort(names);
  return names;
}

void check_folder(const std::filesystem::path& folder) {
  if (!std::filesystem::exists(folder)) {
    const auto parent =
        folder.parent_path().empty() ? std::filesystem::path(".") : folder.parent_path();
    const std::string near = nearest_name(folder.filename().string(), reportable_in(parent));
    throw InputError("there is no folder " + folder.string() +
                     (near.empty() ? "" : "; did you mean '" + near + "'?"));
  }
  if (!std::filesystem::is_directory(folder))
    throw InputError(folder.string() + " is a file; expected the folder of a run or a study");
  if (holds_run(folder) || holds_study(folder)) return;
  std::vector<std::string> inside = reportable_in(folder);
  constexpr std::size_t listed = 10;
  if (inside.size() > listed) inside.resize(listed), inside.emplace_back("...");
  throw InputError(
      folder.string() +
      " holds no run and no study; expected frames.pvd, summary.json or history.csv of `plica "
      "run`, or "
      "study.json of `plica study`" +
      (inside.empty() ? "" : fmt::format(" (folders in it that do: {})", fmt::join(inside, ", "))));
}

// Animation that the run wrote: its level (-1: the surface) and the frames in its collection
struct Listed {
  int level = -1;
  std::vector<FilmEntry> entries;
};

std::vector<Listed> listed_films(const std::filesystem::path& folder) {
  std::vector<Listed> films;
  const auto add = [&](const std::string& file, int level) {
    if (std::filesystem::exists(folder / file))
      films.push_back({level, read_collection(folder / file)});
  };
  add("frames.pvd", -1);
  add("volume.pvd", 0);
  for (int level = 1; level < 100; ++level) add(fmt::format("volume_level{}.pvd", level), level);
  return films;
}

class Maker {
 public:
  explicit Maker(std::filesystem::path folder) : folder_(std::move(folder)) {}

  Report make(std::size_t frames) {
    data_ = {{"title", folder_.filename().string()},
             {"status", nullptr},
             {"summary", nullptr},
             {"up", {0, 0, 1}},
             {"times", Json::array()},
             {"frames_there", 0},
             {"films", Json::array()},
             {"history", nullptr},
             {"probes", nullptr},
             {"study", nullptr},
             {"warnings", Json::array()}};
    if (holds_study(folder_)) add_study();
    if (holds_run(folder_)) add_run(frames);
    data_["warnings"] = report_.warnings;
    report_.html = page();
    return std::move(report_);
  }

 private:
  void add_study() {
    data_["study"] = read_json(folder_ / "study.json", {"name", "status", "duration", "tets",
                                                        "machine", "reference", "rows"});
    data_["title"] = data_["study"]["name"];
    data_["status"] = "study " + data_["study"]["status"].get<std::string>();
  }

  void add_run(std::size_t frames) {
    if (std::filesystem::exists(folder_ / "summary.json")) {
      const Json& summary = data_["summary"] = read_json(
          folder_ / "summary.json", {"name", "status", "levels", "cycle", "macro_step",
                                     "simulated_time", "wall_time", "stages", "diagnosis"});
      data_["title"] = summary["name"], data_["status"] = summary["status"];
      if (summary.contains("gravity")) take_up(summary["gravity"]);
    } else {
      data_["status"] = "unfinished";
      report_.warnings.emplace_back(
          "There is no summary.json: the run goes on, or was killed. Shown is what it has written "
          "so far.");
    }
    if (std::filesystem::exists(folder_ / "history.csv"))
      data_["history"] = read_columns(folder_ / "history.csv", most_rows);
    if (std::filesystem::exists(folder_ / "probes.csv"))
      data_["probes"] = read_columns(folder_ / "probes.csv", most_rows);
    add_films(frames);
    if (report_.frames == 0)
      report_.warnings.emplace_back("There are no frames: the body is not shown.");
  }

  void take_up(const std::vector<double>& gravity) {
    if (gravity.size() == 3 && (gravity[0] != 0 || gravity[1] != 0 || gravity[2] != 0))
      data_["up"] = {-gravity[0], -gravity[1], -gravity[2]};
  }

  void add_films(std::size_t frames) {
    std::vector<Listed> listed = listed_films(folder_);
    if (listed.empty()) return;
    leave_out_moving_parts(listed);
    std::size_t there = listed.front().entries.size();
    for (const Listed& film : listed) there = std::min(there, film.entries.size());
    report_.frames_there = there, data_["frames_there"] = there;
    std::vector<std::optional<SurfaceAnimation>> films(listed.size());
    if (there > 0) read_last(listed, there - 1);
    const std::size_t taken = std::min(there, std::max<std::size_t>(frames, 2));
    for (std::size_t i = 0; i < taken; ++i) {
      const std::size_t frame = taken == 1 ? 0 : i * (there - 1) / (taken - 1);
      if (add_frame(listed, frame, films))
        data_["times"].push_back(listed.front().entries[frame].time);
    }
    report_.frames = data_["times"].size();
    if (report_.frames == 0) return;
    const bool skin_of_level_0 =
        films.size() > 1 && listed[1].level == 0 && films[0]->same_surface(*films[1]);
    for (std::size_t i = skin_of_level_0 ? 1 : 0; i < films.size(); ++i)
      data_["films"].push_back(films[i]->json());
  }

  // Leaves out the film of level 0 where a part of it follows an obstacle: each frame may have
  // other elements
  void leave_out_moving_parts(std::vector<Listed>& listed) {
    if (!data_.contains("summary") || !data_["summary"].contains("followed")) return;
    const auto of_level_0 = [](const Listed& film) { return film.level == 0; };
    if (std::erase_if(listed, of_level_0) > 0)
      report_.warnings.emplace_back(
          "The elements of level 0 are not shown: those near an obstacle change from frame to "
          "frame. The surface is shown.");
  }

  // Reads the last frame of a body that was cut, whose mesh all frames get
  void read_last(const std::vector<Listed>& listed, std::size_t frame) {
    if (!data_.contains("summary") || !data_["summary"].contains("cuts")) return;
    try {
      for (const Listed& film : listed) last_.push_back(read_frame(film.entries[frame].file));
    } catch (const InputError&) {
      last_.clear();  // frames with another mesh are left out
    }
  }

  // Adds a frame to all animations; adds it to none and returns false if one cannot be read
  bool add_frame(const std::vector<Listed>& listed, std::size_t frame,
                 std::vector<std::optional<SurfaceAnimation>>& films) {
    std::vector<FrameFile> files;
    try {
      for (std::size_t i = 0; i < films.size(); ++i) {
        files.push_back(read_frame(listed[i].entries[frame].file));
        if (!last_.empty()) take_mesh_of_last(files[i], last_[i]);
        if (!films[i]) films[i].emplace(listed[i].level, files[i]);
        films[i]->check(files[i]);
      }
    } catch (const InputError& error) {
      const double time = listed.front().entries[frame].time;
      report_.warnings.push_back(
          fmt::format("The frame at {:g} s is left out: {}", time, error.what()));
      return false;
    }
    for (std::size_t i = 0; i < films.size(); ++i) films[i]->add(files[i]);
    return true;
  }

  std::string page() const {
    return filled_page(report_files(), data_["title"].get<std::string>(),
                       data_.dump(-1, ' ', false, Json::error_handler_t::replace));
  }

  std::filesystem::path folder_;
  Json data_;
  std::vector<FrameFile> last_;  // last frame of each film of a body that was cut; else empty
  Report report_;
};

}  // namespace

Report make_report(const std::filesystem::path& folder, std::size_t frames) try {
  check_folder(folder);
  return Maker(folder.has_filename() ? folder : folder.parent_path()).make(frames);
} catch (const Json::exception& error) {
  throw InputError(folder.string() +
                   ": summary.json or study.json is not what plica wrote there: " + error.what());
}

}  // namespace plica::app
