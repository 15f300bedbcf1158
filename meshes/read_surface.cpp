// SPDX-License-Identifier: BSD-3-Clause
#include <plica/meshes/format_of.hpp>
#include <plica/meshes/list.hpp>
#include <plica/meshes/read_surface.hpp>
#include <plica/meshes/sound_surface.hpp>

namespace plica {

TriangleSurface read_surface(const std::filesystem::path& path, SurfaceReport* report) {
  format_of(path, surface_formats, "surface");  // a wrong extension is told before the file is looked for
  return read_surface(load_file(path), report);
}

TriangleSurface read_surface(const MemoryFile& file, SurfaceReport* report) {
  MeshReport found;
  SurfaceReport mended;
  const RawMesh raw = format_of(file.name, surface_formats, "surface").parse(file, found);
  TriangleSurface surface = sound_surface(raw, found, mended);
  if (report) *report = std::move(mended);
  return surface;
}

}  // namespace plica
