// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>
#include <cstring>
#include <plica/core/error.hpp>
#include <plica/core/model.hpp>
#include <string>
#include <vector>

namespace plica {

/// Archive of what a simulation carries from one macro step to the next. Each owner names its
/// numbers and fields once. The archive saves them, checks that saved bytes fit them, or restores
/// them.
template <class B>
class Archive {
 public:
  enum class Task { save, check, restore };

  Archive(Task task, std::vector<unsigned char>& bytes) : task_(task), bytes_(bytes) {}

  template <class Number>
  void number(Number& value) {
    static_assert(std::is_arithmetic_v<Number>);
    if (task_ == Task::save)
      put(&value, sizeof value);
    else if (const unsigned char* from = take(sizeof value); task_ == Task::restore)
      std::memcpy(&value, from, sizeof value);
  }

  /// Saves a number that must be equal later; throws InputError where it differs from the saved
  /// one.
  template <class Number>
  void same(const std::string& what, Number value) {
    Number saved = value;
    if (task_ == Task::save) return number(saved);
    std::memcpy(&saved, take(sizeof saved), sizeof saved);
    if (saved != value)
      throw InputError("the saved state is that of another simulation: " + what + " differs");
  }

  /// Saves, checks or restores a device field, which may be empty.
  template <class View>
  void field(const std::string& what, const View& view) {
    const std::size_t size = fields::bytes_of(view);
    same<std::uint64_t>("the size of " + what, size);
    if (task_ == Task::save) {
      bytes_.resize(bytes_.size() + size);
      Kokkos::fence("plica::archive");
      fields::download(typename B::Exec(), bytes_.data() + bytes_.size() - size, view.data(), size);
    } else if (const unsigned char* from = take(size); task_ == Task::restore && size > 0) {
      fields::upload<typename View::memory_space>(view.data(), from, size);
    }
  }
  void state(const std::string& what, const State<B>& state) {
    field(what + ".u", state.u);
    field(what + ".v", state.v);
  }

  bool restoring() const { return task_ == Task::restore; }
  /// Throws InputError where bytes are left over. Call it after all numbers and fields.
  void finish() const {
    if (task_ != Task::save && at_ != bytes_.size())
      throw InputError("the saved state is damaged: " + std::to_string(bytes_.size() - at_) +
                       " bytes too many");
  }

 private:
  void put(const void* data, std::size_t size) {
    const auto* from = static_cast<const unsigned char*>(data);
    bytes_.insert(bytes_.end(), from, from + size);
  }
  const unsigned char* take(std::size_t size) {
    if (bytes_.size() - at_ < size) throw InputError("the saved state is damaged: it ends early");
    at_ += size;
    return bytes_.data() + (at_ - size);
  }

  Task task_;
  std::vector<unsigned char>& bytes_;
  std::size_t at_ = 0;
};

}  // namespace plica
