// SPDX-License-Identifier: Apache-2.0
// CARMEN logs, looked through and read.
#include "drivers/carmen/carmen_bytes.hpp"
#include "drivers/carmen/carmen_survey.hpp"
#include "tests/fuzz/input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace deltamap;
  const fuzz::MemoryFile file{{data, size}};
  try {
    const auto survey = drivers::carmen::survey_of(file.path(), std::nullopt);
    drivers::carmen::CarmenLog log{file.path(), survey.clock, survey.headings};
    while (const auto record = log.next()) {
      if (const auto* scan = std::get_if<drivers::carmen::CarmenScan>(&*record))
        (void)drivers::carmen::measurement_of(*scan, survey);
    }
  } catch (const std::runtime_error&) {
  }
  return 0;
}
