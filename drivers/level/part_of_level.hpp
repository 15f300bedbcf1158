// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <optional>
#include <plica/core/rank_part.hpp>
#include <plica/core/ranks.hpp>
#include <plica/drivers/elastic/level_constants.hpp>
#include <plica/drivers/loads/assemble_loads.hpp>
#include <plica/meshes/embedding.hpp>
#include <span>
#include <string>
#include <vector>

// How a mesh is shared out to ranks. Each rank knows the whole mesh during set-up, and finds what
// it sends and receives without asking the others.
namespace plica {

/// Ranges of a mesh that ranks own, [ranks + 1] each: rank r has those from r to before r + 1.
struct RankRanges {
  std::vector<int> vertex;  ///< first vertex of each rank, a whole number of blocks
  std::vector<int> run;     ///< first run of tetrahedra of each rank

  int ranks() const { return static_cast<int>(vertex.size()) - 1; }
  int owner(int v) const;         ///< returns the rank that owns a vertex
  int owner_of_run(int p) const;  ///< returns the rank that owns a run
};

/// Shares a mesh out, so that all ranks have about as many tetrahedra.
/// @param runs   all tetrahedra, see element_runs()
/// @param block  number of vertices that are owned together, see vertex_block
RankRanges rank_ranges(const TetMesh& mesh, const std::vector<std::vector<int>>& runs, int ranks,
                       int block = 512);

/// All tetrahedra at the vertices that a rank owns, of which it assembles the rows of a matrix.
/// Elements at the border are in the parts of several ranks, so that no block is sent.
struct MatrixPart {
  std::vector<int> tet;  ///< numbers in the whole mesh, ascending
  TetMesh mesh;          ///< tetrahedra, with the local numbers of the part's vertices
  /// tetrahedra that each run of the whole mesh has of them
  std::vector<std::vector<int>> runs;
  std::vector<FibreAxes> fibres;  ///< per tetrahedron; empty: see LevelConstants
};

/// Part of a mesh that one rank has, and what it exchanges with others.
struct LevelPart {
  Ranks* ranks = nullptr;  ///< ranks that share the level; null: it is only a plan
  int number = 0;          ///< number of the level, which messages name
  bool nodal = false;      ///< kind of its elements
  RankPart part;           ///< numbers of its vertices and tetrahedra
  TetMesh mesh;            ///< vertices and tetrahedra of the part, with local numbers
  /// own runs, of local tetrahedra; of linear elements
  std::vector<std::vector<int>> runs;
  HaloRows shares;  ///< rows of `partial`, of linear elements
  /// Vertex and row of each share in the order in which a vertex adds them, of linear elements
  std::vector<int> share_vertex, share_row;
  HaloRows vertices;  ///< rows of vertices, of nodal elements and with a matrix
  std::optional<MatrixPart> matrix;

  /// Returns a name for messages of the level.
  std::string named(const char* what) const {
    return std::string(what) + " of level " + std::to_string(number);
  }
};

/// Returns the part of rank `own`.
///
/// Linear elements: the tetrahedra of own runs, with their vertices and all owned ones. Nodal ones:
/// all tetrahedra at owned vertices. A matrix adds the neighbours of owned vertices.
/// @param matrix  whether matrices of the level are assembled
LevelPart part_of_level(const TetMesh& mesh, Element element,
                        const std::vector<std::vector<int>>& runs, const RankRanges& ranges,
                        int own, bool matrix = false);
/// Returns this rank's part of a level in a simulation of several ranks.
LevelPart part_of_level(const TetMesh& mesh, Element element, Ranks& ranks, int block = 512,
                        bool matrix = false);

/// Returns the constants of the part's vertices and tetrahedra.
LevelConstants constants_of_part(const LevelConstants& whole, const RankPart& part);
/// Returns the loads on the part's vertices.
std::vector<AssembledLoad> loads_of_part(const std::vector<AssembledLoad>& whole,
                                         const RankPart& part);
/// Returns the sets with the vertices that the rank owns, as local numbers.
std::vector<HeldSet> held_by_part(const std::vector<HeldSet>& whole, const RankPart& part);

/// Vertices of a shared level that a rank reads for its part of the level beside it.
struct ReadVertices {
  std::vector<int> vertex;  ///< numbers in the whole mesh, ascending
  HaloRows rows;            ///< rows that ranks send to each other; `sent`: local rows of the level
  std::vector<int> own;     ///< local rows of those that the rank owns itself

  /// Returns the place of a vertex of the whole mesh in `vertex`, which has it.
  int place(int v) const;
};

/// Finds what each rank sends of a shared level. All ranks call this.
/// @param of    this rank's part of the level
/// @param read  vertices that this rank reads, by their numbers in the whole mesh, in any order
ReadVertices read_vertices(Ranks& ranks, const RankPart& of, std::vector<int> read);

/// Returns the rows of an embedding for a part's vertices; null: for all.
Embedding embedding_of_part(const Embedding& whole, const RankPart* part);
/// Returns the vertices that an embedding reads.
std::vector<int> read_by(const Embedding& embedding);
/// Returns an embedding whose vertices are places in what is read.
Embedding with_places(Embedding embedding, const ReadVertices& read);

/// Numbers of a mesh that is shared out to ranks.
struct RankPlan {
  std::int64_t tets = 0, vertices = 0;  ///< numbers of what it owns
  std::int64_t copies = 0;              ///< vertices that it has besides
  std::int64_t sent = 0, received = 0;  ///< rows of each force
  int neighbours = 0;                   ///< ranks that it receives rows from
};

/// Returns the runs of tetrahedra that are patches on any backend.
std::vector<std::vector<int>> runs_of_patches(const TetMesh& mesh);
/// Returns for each rank what it would have and exchange.
/// @param runs  runs_of_patches() of the mesh
std::vector<RankPlan> plan_ranks(const TetMesh& mesh, Element element,
                                 const std::vector<std::vector<int>>& runs, int ranks,
                                 int block = 512);

}  // namespace plica
