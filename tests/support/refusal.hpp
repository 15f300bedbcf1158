// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/error.hpp>
#include <string>

namespace plica::test {

/// What the InputError says that the call throws; empty where it throws none.
template <class Call>
std::string refusal(const Call& call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

}  // namespace plica::test
