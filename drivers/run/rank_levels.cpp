// SPDX-License-Identifier: BSD-3-Clause
#include <plica/core/row_ranges.hpp>
#include <plica/core/text.hpp>
#include <plica/drivers/contact/build_surface.hpp>
#include <plica/drivers/run/rank_levels.hpp>
#include <utility>

namespace plica {

template <class B>
void RankLevels<B>::add(const TetMesh& mesh, const LevelConstants& constants, bool matrix) {
  const std::size_t i = own_.size();
  Own& own = own_.emplace_back();
  own.mesh = &mesh, own.constants = &constants;
  if (!shares(i)) return;
  own.part = part_of_level(mesh, constants.element, *ranks_, vertex_block<B>, matrix);
  own.part->number = static_cast<int>(i);
  if (matrix && !constants.fibres.empty())
    for (const int e : own.part->matrix->tet)
      own.part->matrix->fibres.push_back(constants.fibres[index_of(e)]);
  own.of_part = constants_of_part(constants, own.part->part);
  own.mesh = &own.part->mesh, own.constants = &own.of_part;
}

template <class B>
auto RankLevels<B>::gather(const ReadVertices& read, std::size_t from, std::size_t to) const
    -> Gathered {
  return std::make_shared<const GatheredVertices<B>>(
      *ranks_, text("vertices of level ", from, " for level ", to), read.rows, read.own);
}

template <class B>
Transfer<B> RankLevels<B>::interpolation(const std::string& name, const Embedding& whole,
                                         std::size_t from, std::size_t to,
                                         Gathered& gathered) const {
  Embedding rows = embedding_of_part(whole, part(to) ? &part(to)->part : nullptr);
  if (part(from)) {
    const ReadVertices read = read_vertices(*ranks_, part(from)->part, read_by(rows));
    gathered = gather(read, from, to);
    rows = with_places(std::move(rows), read);
  }
  return build_transfer<B>(name, rows, constants(to).constrained);
}

template <class B>
Restriction<B> RankLevels<B>::restriction(std::vector<RestrictionRow> rows, std::size_t from,
                                          std::size_t to, Gathered& gathered) const {
  if (part(to)) rows = part(to)->part.local(rows);
  if (part(from)) {
    std::vector<int> all;
    for (const RestrictionRow& row : rows)
      all.insert(all.end(), row.source.begin(), row.source.end());
    const ReadVertices read = read_vertices(*ranks_, part(from)->part, std::move(all));
    gathered = gather(read, from, to);
    for (RestrictionRow& row : rows)
      for (int& v : row.source) v = read.place(v);
  }
  return build_restriction<B>(rows);
}

#define PLICA_INSTANTIATE(Real, Exec) template class RankLevels<Backend<Real, Exec>>;
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
