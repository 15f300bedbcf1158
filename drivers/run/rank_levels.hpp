// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <deque>
#include <memory>
#include <optional>
#include <plica/core/transfer.hpp>
#include <plica/drivers/body/masses.hpp>
#include <plica/drivers/level/part_of_level.hpp>
#include <plica/kernels/halo.hpp>
#include <string>
#include <vector>

namespace plica {

/// Levels of a body as this rank has them: its parts of those that ranks share, the others whole.
template <class B>
class RankLevels {
 public:
  using Gathered = std::shared_ptr<const GatheredVertices<B>>;

  /// @param ranks          null: one process has all levels
  /// @param shares_coarse  whether ranks share the levels beside level 0, too
  RankLevels(Ranks* ranks, bool shares_coarse) : ranks_(ranks), shares_coarse_(shares_coarse) {}

  Ranks* ranks() const { return ranks_; }
  bool shares(std::size_t i) const { return ranks_ && (i == 0 || shares_coarse_); }

  /// Adds the next level. All ranks call this.
  /// @param mesh, constants  of the whole level; they outlive this
  /// @param matrix           whether matrices of it are assembled
  void add(const TetMesh& mesh, const LevelConstants& constants, bool matrix);
  /// Returns this rank's part of a level; null: it has all of it.
  const LevelPart* part(std::size_t i) const { return own_[i].part ? &*own_[i].part : nullptr; }
  /// Returns the mesh and the constants of what the rank has of a level.
  const TetMesh& mesh(std::size_t i) const { return *own_[i].mesh; }
  const LevelConstants& constants(std::size_t i) const { return *own_[i].constants; }

  /// Returns the interpolation of level `to` from level `from`. All ranks call this.
  /// @param whole     embedding of all vertices of level `to` in level `from`
  /// @param gathered  set to what the interpolation reads where ranks share level `from`
  Transfer<B> interpolation(const std::string& name, const Embedding& whole, std::size_t from,
                            std::size_t to, Gathered& gathered) const;
  /// Returns the restriction to level `to` from level `from`, of rows for all its vertices.
  Restriction<B> restriction(std::vector<RestrictionRow> rows, std::size_t from, std::size_t to,
                             Gathered& gathered) const;

 private:
  struct Own {
    std::optional<LevelPart> part = {};
    LevelConstants of_part = {};
    const TetMesh* mesh = nullptr;
    const LevelConstants* constants = nullptr;
  };
  Ranks* ranks_;
  bool shares_coarse_;
  std::deque<Own> own_;  ///< per level; a new one moves no other

  Gathered gather(const ReadVertices& read, std::size_t from, std::size_t to) const;
};

}  // namespace plica
