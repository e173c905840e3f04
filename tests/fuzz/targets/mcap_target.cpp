// SPDX-License-Identifier: Apache-2.0
// MCAP files and the messages in them.
#include "tests/fuzz/recorded_messages.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  deltamap::fuzz::try_recording(deltamap::tool::read_mcap, data, size);
  return 0;
}
