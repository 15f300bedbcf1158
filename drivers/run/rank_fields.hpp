// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/rank_part.hpp>
#include <plica/core/ranks.hpp>
#include <plica/core/shared_fields.hpp>
#include <vector>

namespace plica {

/// Items of a level that one of several ranks has.
struct RankItems {
  const RankPart* part = nullptr;      ///< part of the level; null: each rank has all of it
  std::vector<int> points = {};        ///< numbers of the rank's surface points, ascending
  std::vector<int> owned_points = {};  ///< places in `points` of those that it owns
  int obstacles = 0;                   ///< number of obstacles of the body
  std::size_t element_bytes = 0;       ///< size of the rank's field of elements
  std::size_t slots = 0;               ///< number of the rank's slots of nodal elements
};

/// Fields of levels that several ranks share, in the order of the whole mesh:
///
///   vertices   | owned by rank 0 | by rank 1 | ...       a rank has these and copies of others
///   elements   | packs of rank 0 | of rank 1 | ...       a rank has just these
///   slots      | slots of rank 0 | of rank 1 | ...       likewise
///   numbered   rows with numbers, in their order
///   contacts   obstacle 0: points 0, 1, ... | obstacle 1: ...   a rank has some points of each
class RankFields final : public SharedFields {
 public:
  /// Finds out what each rank has. All ranks call this.
  /// @param levels  items of each level
  RankFields(Ranks& ranks, std::vector<RankItems> levels);

  bool shares(const RowsOfField& rows) const override;
  std::size_t bytes(const RowsOfField& rows) const override;
  std::vector<unsigned char> whole(const RowsOfField& rows,
                                   const std::vector<unsigned char>& local) const override;
  std::vector<unsigned char> local(const RowsOfField& rows,
                                   const unsigned char* whole) const override;

 private:
  using Field = std::vector<unsigned char>;
  /// One level: what this rank has of it, and what all have.
  struct LevelItems {
    RankItems own;
    std::size_t vertices = 0;                      ///< number of vertices of the whole mesh
    std::size_t elements_before = 0;               ///< size of elements of ranks before [bytes]
    std::size_t elements = 0;                      ///< size of the elements of all ranks [bytes]
    std::size_t slots_before = 0, slots = 0;       ///< numbers of slots of these ranks
    std::size_t points = 0;                        ///< number of points of the whole surface
    std::vector<std::vector<int>> points_of = {};  ///< points that each rank owns
  };
  Ranks& ranks_;
  std::vector<LevelItems> levels_;

  LevelItems found(RankItems own) const;
  Field whole_of_numbered(const RowsOfField& rows, const Field& local) const;
  static Field owned(const LevelItems& level, const RowsOfField& rows, const Field& local);
};

}  // namespace plica
