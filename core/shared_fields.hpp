// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstddef>
#include <vector>

// Fields that are saved as one process has them, whatever the number of ranks that share them.
namespace plica {

/// Items that the rows of a field are of, where several ranks may share them.
enum class RowItems {
  whole,     ///< items that each rank has all of
  vertices,  ///< vertices of a level
  elements,  ///< a rank's own elements, in whole packs; they follow those of the rank before it
  slots,     ///< a rank's own slots of nodal elements; they follow those of the rank before it
  contacts,  ///< slots of contact: of each obstacle one for each surface point
  /// slots of contact, of which the field has the surface points' numbers; negative: none
  points_of_contacts,
  numbered  ///< items of any kind, by RowNumbers
};

/// Numbers of a rank's rows among the rows of all ranks.
struct RowNumbers {
  std::vector<int> number;   ///< [rows] -1: a row that is not saved
  std::vector<char> is_own;  ///< [rows] nonzero where this rank saves the row; one does
  std::size_t all = 0;       ///< number of rows of all ranks
};

/// Rows of one field.
struct RowsOfField {
  RowItems of = RowItems::whole;
  std::size_t bytes = 0;                ///< size of a row
  bool present = true;                  ///< false: the field is left out on all ranks
  std::size_t level = 0;                ///< level that the items are of
  const RowNumbers* numbers = nullptr;  ///< numbers of numbered rows; null: each rank has all
};

/// Maker of whole fields from parts of them, and back. Fields are bytes in the host's memory.
class SharedFields {
 public:
  virtual ~SharedFields() = default;
  /// Returns whether ranks share these rows. The functions below are for such rows alone.
  virtual bool shares(const RowsOfField& rows) const = 0;
  /// Returns the size of the whole field.
  virtual std::size_t bytes(const RowsOfField& rows) const = 0;
  /// Returns the whole field on rank 0, and nothing elsewhere. All ranks call this.
  virtual std::vector<unsigned char> whole(const RowsOfField& rows,
                                           const std::vector<unsigned char>& local) const = 0;
  /// Returns this rank's rows of a whole field.
  virtual std::vector<unsigned char> local(const RowsOfField& rows,
                                           const unsigned char* whole) const = 0;
};

}  // namespace plica
