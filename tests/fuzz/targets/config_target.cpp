// SPDX-License-Identifier: Apache-2.0
// Settings.
#include "daemon/settings/settings.hpp"
#include "tests/fuzz/input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace deltamap;
  try {
    (void)daemon::parse_settings(std::string(fuzz::text_of({data, size})), "fuzz");
  } catch (const std::runtime_error&) {
  }
  return 0;
}
