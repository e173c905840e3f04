// SPDX-License-Identifier: Apache-2.0
// Recordings.
#include "drivers/port/byte_log.hpp"
#include "tests/fuzz/input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace deltamap;
  const fuzz::MemoryFile file{{data, size}};
  try {
    drivers::port::ByteLogReader reader{file.path()};
    while (reader.next()) {
    }
    (void)reader.faults().lines();
  } catch (const std::runtime_error&) {
  }
  return 0;
}
