// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <plica/drivers/app/output/frames.hpp>
#include <plica/drivers/app/output/write_file.hpp>

namespace plica::app {

Frames::Frames(std::filesystem::path folder, std::string name, std::string collection)
    : folder_(std::move(folder)), name_(std::move(name)), collection_(std::move(collection)) {
  make_folder(folder_ / "frames");
  std::error_code ignored;
  std::filesystem::remove(folder_ / collection_, ignored);
  std::vector<std::filesystem::path> stale;
  for (const auto& entry : std::filesystem::directory_iterator(folder_ / "frames"))
    if (entry.path().filename().string().starts_with(name_ + "_")) stale.push_back(entry.path());
  for (const auto& file : stale) std::filesystem::remove(file, ignored);
}

void Frames::write(const VtuGrid& grid) {
  const std::string file = fmt::format("frames/{}_{:04}.vtu", name_, entries_);
  write_file(folder_ / file, vtu_text(grid));
  list_ += fmt::format("    <DataSet timestep=\"{:.12g}\" part=\"0\" file=\"{}\"/>\n", grid.time, file);
  ++entries_;
  write_file(folder_ / collection_, fmt::format("<?xml version=\"1.0\"?>\n"
                                                "<VTKFile type=\"Collection\" version=\"1.0\">\n"
                                                "  <Collection>\n{}  </Collection>\n"
                                                "</VTKFile>\n",
                                                list_));
}

}  // namespace plica::app
