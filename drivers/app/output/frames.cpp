// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <charconv>
#include <plica/core/error.hpp>
#include <plica/drivers/app/output/frames.hpp>
#include <plica/drivers/app/output/write_file.hpp>

namespace plica::app {

Frames::Frames(std::filesystem::path folder, std::string name, std::string collection, const std::vector<double>& times)
    : folder_(std::move(folder)), name_(std::move(name)), collection_(std::move(collection)) {
  make_folder(folder_ / "frames");
  for (const double time : times) {
    if (!std::filesystem::exists(folder_ / file_of(entries_)))
      throw InputError("cannot resume: there is no " + (folder_ / file_of(entries_)).string() + " any more");
    enlist(time);
  }
  std::error_code ignored;
  if (entries_ == 0)
    std::filesystem::remove(folder_ / collection_, ignored);
  else
    write_collection();
  remove_later();
  synchronised_ = entries_;
}

std::string Frames::file_of(std::size_t entry) const { return fmt::format("frames/{}_{:04}.vtu", name_, entry); }

void Frames::enlist(double time) {
  list_ += fmt::format("    <DataSet timestep=\"{:.12g}\" part=\"0\" file=\"{}\"/>\n", time, file_of(entries_));
  ++entries_;
}

void Frames::write_collection() const {
  write_file(folder_ / collection_, fmt::format("<?xml version=\"1.0\"?>\n"
                                                "<VTKFile type=\"Collection\" version=\"1.0\">\n"
                                                "  <Collection>\n{}  </Collection>\n"
                                                "</VTKFile>\n",
                                                list_));
}

// Files NAME_NUMBER.vtu with a number that is not in the list, and drafts
void Frames::remove_later() {
  std::vector<std::filesystem::path> stale;
  for (const auto& entry : std::filesystem::directory_iterator(folder_ / "frames")) {
    const std::string file = entry.path().filename().string(), start = name_ + "_";
    if (!file.starts_with(start)) continue;
    std::size_t number = 0;
    const auto [rest, error] = std::from_chars(file.data() + start.size(), file.data() + file.size(), number);
    const std::string_view ending(rest, static_cast<std::size_t>(file.data() + file.size() - rest));
    if (error == std::errc{} && (ending == ".vtu.part" || (ending == ".vtu" && number >= entries_)))
      stale.push_back(entry.path());
  }
  std::error_code ignored;
  for (const auto& file : stale) std::filesystem::remove(file, ignored);
}

void Frames::write(const VtuGrid& grid) {
  write_file(folder_ / file_of(entries_), vtu_text(grid));
  enlist(grid.time);
  write_collection();
}

void Frames::sync() {
  if (synchronised_ == entries_) return;
  for (; synchronised_ < entries_; ++synchronised_) sync_file(folder_ / file_of(synchronised_));
  sync_file(folder_ / collection_);
  sync_file(folder_ / "frames");
}

}  // namespace plica::app
