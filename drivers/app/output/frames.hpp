// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <filesystem>
#include <plica/core/mesh.hpp>
#include <string>
#include <vector>

namespace plica::app {

/// Triangles or tetrahedra, with values at vertices and in cells.
struct VtuGrid {
  struct PointField {
    std::string name;
    std::vector<Point> values;
  };
  struct ScalarField {
    std::string name;
    std::vector<double> values;
    int components = 1;
  };
  struct CellField {
    std::string name;
    std::vector<int> values;
  };
  std::vector<Point> points;      ///< positions of the vertices [m]
  std::vector<int> connectivity;  ///< vertices of the cells, one cell after the other
  int vertices_per_cell = 3;      ///< 3: triangles, 4: tetrahedra
  std::vector<PointField> point_fields;
  std::vector<ScalarField> point_scalars;
  std::vector<CellField> cell_fields;
  std::vector<ScalarField> cell_scalars;
  std::vector<PointField> cell_vectors;
  double time = 0;  ///< simulated time [s]
};

/// Returns the grid as a VTK XML file (.vtu) in double precision.
std::string vtu_text(const VtuGrid& grid);

/// Writer of an animation: one .vtu file per frame in the folder `frames`, and a collection (.pvd).
/// The collection is beside that folder; viewers open it. After each frame the collection on disk
/// names all frames that exist.
class Frames {
 public:
  /// Prepares to write folder/frames/NAME_0000.vtu ... and folder/COLLECTION. The first frames, at
  /// these `times` [s], exist already; later frames of a former run are removed. Throws InputError
  /// if one of the first frames is missing.
  Frames(std::filesystem::path folder, std::string name, std::string collection,
         const std::vector<double>& times = {});
  void write(const VtuGrid& grid);
  void cut_back(std::size_t count);  ///< keeps the first `count` frames and removes the others
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
