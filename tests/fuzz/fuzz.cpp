// SPDX-License-Identifier: BSD-3-Clause
#include <cstdint>

#include PLICA_FUZZ_HEADER

// libFuzzer's entry for the target that PLICA_FUZZ_TARGET names (README.md)
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  for (const auto& target : plica::fuzz::PLICA_FUZZ_TARGETS)
    if (target.name == PLICA_FUZZ_TARGET) target.run({reinterpret_cast<const char*>(data), size});
  return 0;
}
