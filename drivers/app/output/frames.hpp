// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <filesystem>
#include <plica/core/mesh.hpp>
#include <string>
#include <vector>

namespace plica::app {

/// Triangles or tetrahedra with values at their vertices and on themselves.
struct VtuGrid {
  struct PointField {
    std::string name;
    std::vector<Point> values;
  };
  struct ScalarField {
    std::string name;
    std::vector<double> values;
  };
  struct CellField {
    std::string name;
    std::vector<int> values;
  };
  std::vector<Point> points;      ///< [m]
  std::vector<int> connectivity;  ///< the cells' vertices, one cell after the other
  int vertices_per_cell = 3;      ///< 3: triangles, 4: tetrahedra
  std::vector<PointField> point_fields;
  std::vector<ScalarField> point_scalars;
  std::vector<CellField> cell_fields;
  std::vector<ScalarField> cell_scalars;
  std::vector<PointField> cell_vectors;
  double time = 0;  ///< [s]
};

/// The grid as VTK's XML file (.vtu), its numbers appended in raw binary, double precision.
/// Source: the VTK file formats,
/// https://docs.vtk.org/en/latest/vtk_file_formats/vtkxml_file_format.html
std::string vtu_text(const VtuGrid& grid);

/// A film: one file per point in time in the folder `frames`, and beside it the collection that
/// viewers open. After every frame the collection on disk names the frames that are there.
class Frames {
 public:
  /// Writes folder/frames/NAME_0000.vtu ... and folder/NAME.pvd, or another COLLECTION. The first
  /// frames, at these `times`, are there already; those of a former run behind them are removed.
  /// InputError where one is missing.
  Frames(std::filesystem::path folder, std::string name, std::string collection,
         const std::vector<double>& times = {});
  void write(const VtuGrid& grid);
  void cut_back(std::size_t count);  ///< to the first so many: what comes next replaces the others
  std::size_t count() const { return entries_; }
  /// Waits until the frames since the last call are on the disk.
  void sync();

 private:
  std::string file_of(std::size_t entry) const;
  void enlist(double time);
  void write_collection() const;
  void remove_others();

  std::filesystem::path folder_;
  std::string name_, collection_, list_;
  std::size_t entries_ = 0, synchronised_ = 0;
};

}  // namespace plica::app
