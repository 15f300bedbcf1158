// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <plica/core/each_array.hpp>
#include <plica/core/error.hpp>
#include <plica/core/model.hpp>
#include <plica/core/shared_fields.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace plica {

template <class B>
class Archive;

/// Copy of what was named to an archive, with fields in the device's memory.
template <class B>
class KeptValues {
 public:
  /// Names the copies, in the order in which they were named to it.
  void name_fields(Archive<B>& archive) {
    for (Value& value : values_)
      value.number.empty() ? archive.field("a kept field", value.field, value.rows)
                           : archive.number(value.number.data(), value.number.size());
  }

 private:
  friend class Archive<B>;
  struct Value {
    Kokkos::View<unsigned char*, typename B::Memory> field;
    RowsOfField rows;
    std::vector<unsigned char> number;  ///< bytes of a number; empty: a field
  };
  std::vector<Value> values_;
};

/// Visitor of all that an object holds. A class names its fields and numbers once, in a function
/// name_fields(archive): field() and number() for what it carries from one macro step to the next,
/// owns() for other arrays. The task of the archive says what happens with them.
template <class B>
class Archive {
 public:
  using Exec = typename B::Exec;
  enum class Task {
    measure,  ///< adds up the memory of all arrays
    save,     ///< writes what is carried to bytes
    check,    ///< throws InputError where bytes do not fit
    restore,  ///< reads what is carried from bytes
    keep,     ///< copies what is carried to KeptValues, in the order of an execution space
    put_back  ///< copies it back
  };

  Archive() : task_(Task::measure) {}
  /// @param shared  maker of whole fields, on one of several ranks; null: one process. Fields are
  ///                saved whole, in the bytes of rank 0
  Archive(Task task, std::vector<unsigned char>& bytes, const SharedFields* shared = nullptr)
      : task_(task), bytes_(&bytes), shared_(shared) {}
  Archive(Task task, KeptValues<B>& kept, const Exec& exec)
      : task_(task), kept_(&kept), exec_(exec) {}

  /// Says which level the fields that are named next belong to.
  void set_level(std::size_t level) { level_ = level; }

  template <class Number>
  void number(Number& value) {
    static_assert(std::is_arithmetic_v<Number>);
    number(&value, sizeof value);
  }
  /// Names a number of `size` bytes.
  void number(void* value, std::size_t size) {
    auto* const own = static_cast<unsigned char*>(value);
    if (task_ == Task::save) bytes_->insert(bytes_->end(), own, own + size);
    if (task_ == Task::check) take(size);
    if (task_ == Task::restore) std::memcpy(own, take(size), size);
    if (task_ == Task::keep) next().number.assign(own, own + size);
    if (task_ == Task::put_back) std::memcpy(own, next().number.data(), size);
  }

  /// Names a number that must be equal later; throws InputError where it differs from the saved
  /// one.
  template <class Number>
  void same(const std::string& what, Number value) {
    if (task_ == Task::save) return number(value);
    Number saved;
    std::memcpy(&saved, take(sizeof saved), sizeof saved);
    if (saved != value)
      throw InputError("the saved state is that of another simulation: " + what + " differs");
  }

  /// Names how many things follow. Returns the saved number, or `now` where the task is to save.
  std::size_t count(std::size_t now) {
    auto many = static_cast<std::uint64_t>(now);
    if (task_ == Task::save) return number(many), now;
    std::memcpy(&many, take(sizeof many), sizeof many);
    if (many > bytes_->size())
      throw InputError("the saved state is damaged: a number is too large");
    return static_cast<std::size_t>(many);
  }

  /// Begins a part that not every saved state has. Returns whether the saved bytes go on with it;
  /// `present` says so where the task is to save.
  bool part(std::uint64_t mark, bool present) {
    if (task_ == Task::save) return present ? (number(mark), true) : false;
    std::uint64_t next = 0;
    if (bytes_->size() - at_ < sizeof next) return false;
    std::memcpy(&next, bytes_->data() + at_, sizeof next);
    if (next == mark) at_ += sizeof next;
    return next == mark;
  }

  /// Names a device field that is carried, which may be empty.
  /// @param items  what its rows are of, where several ranks share the body
  template <class View>
  void field(const std::string& what, const View& view, RowItems items = RowItems::whole) {
    std::size_t row = sizeof(typename View::value_type);
    for (std::size_t k = 1; k < View::rank(); ++k) row *= view.extent(k);
    field(what, view,
          RowsOfField{items, row, view.use_count() > 0 || view.extent(0) > 0, level_, nullptr});
  }
  /// Names a device field whose rows have numbers, where several ranks share it.
  /// @param numbers  null: this process has all rows
  template <class View>
  void field(const std::string& what, const View& view, const RowNumbers* numbers) {
    const std::size_t row = fields::bytes_of(view) / std::max<std::size_t>(1, view.extent(0));
    field(what, view, RowsOfField{RowItems::numbered, row, true, level_, numbers});
  }
  template <class View>
  void field(const std::string& what, const View& view, const RowsOfField& rows) {
    const std::size_t size = fields::bytes_of(view);
    if (task_ == Task::measure) return owns(view);
    if (task_ == Task::keep || task_ == Task::put_back) return exchange(view.data(), size, rows);
    const bool shared = shared_ && shared_->shares(rows);
    if (task_ == Task::save) {
      std::vector<unsigned char> own(size);
      Kokkos::fence("plica::archive");
      fields::download(Exec(), own.data(), view.data(), size);
      if (shared) own = shared_->whole(rows, own);
      count(own.size());
      bytes_->insert(bytes_->end(), own.begin(), own.end());
      return;
    }
    const std::size_t saved = shared ? shared_->bytes(rows) : size;
    same<std::uint64_t>("the size of " + what, saved);
    const unsigned char* from = take(saved);
    if (task_ != Task::restore || size == 0) return;
    std::vector<unsigned char> own;
    if (shared) own = shared_->local(rows, from), from = own.data();
    fields::upload<typename View::memory_space>(view.data(), from, size);
  }
  /// Names a state of the level's vertices.
  void state(const std::string& what, const State<B>& state) {
    field(what + ".u", state.u, RowItems::vertices);
    field(what + ".v", state.v, RowItems::vertices);
  }

  /// Names arrays that are not carried: of constants and of work. See each_array().
  template <class... Owned>
  void owns(const Owned&... owned) {
    const auto count = [this](const auto& array) {
      if (array.use_count() > 0 && counted_.insert(array.data()).second)
        measured_ += fields::bytes_of(array);
    };
    if (task_ == Task::measure) (each_array(owned, count), ...);
  }
  /// Returns the memory of the arrays that were named since the last call [bytes]. An array is
  /// counted when it is first named, and not where it is lent.
  std::size_t measured() { return std::exchange(measured_, 0); }

  /// Returns whether the task is to write bytes.
  bool saving() const { return task_ == Task::save; }
  /// Returns whether what is carried becomes that of another time.
  bool restoring() const { return task_ == Task::restore || task_ == Task::put_back; }
  /// Throws InputError where bytes are left over. Call it after all numbers and fields.
  void finish() const {
    if (task_ != Task::save && at_ != bytes_->size())
      throw InputError("the saved state is damaged: " + std::to_string(bytes_->size() - at_) +
                       " bytes too many");
  }

 private:
  const unsigned char* take(std::size_t size) {
    if (bytes_->size() - at_ < size) throw InputError("the saved state is damaged: it ends early");
    at_ += size;
    return bytes_->data() + (at_ - size);
  }
  typename KeptValues<B>::Value& next() {
    if (at_ == kept_->values_.size()) kept_->values_.emplace_back();
    return kept_->values_[at_++];
  }
  void exchange(void* own, std::size_t size, const RowsOfField& rows) {
    auto& value = next();
    auto& kept = value.field;
    value.rows = rows;
    if (kept.extent(0) != size) kept = unset<std::decay_t<decltype(kept)>>("plica::kept", size);
    task_ == Task::keep ? fields::copy_bytes(exec_, kept.data(), own, size)
                        : fields::copy_bytes(exec_, own, kept.data(), size);
  }

  Task task_;
  std::vector<unsigned char>* bytes_ = nullptr;
  const SharedFields* shared_ = nullptr;
  KeptValues<B>* kept_ = nullptr;
  std::size_t at_ = 0;     ///< place in the bytes or values
  std::size_t level_ = 0;  ///< level of what is named
  Exec exec_;
  std::set<const void*> counted_;
  std::size_t measured_ = 0;
};

}  // namespace plica
