// SPDX-License-Identifier: Apache-2.0
// A folder, a board of outputs and the warnings: what tests of saving look at.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "core/time.hpp"
#include "daemon/outputs/retrying_output.hpp"
#include "daemon/telemetry/telemetry.hpp"
#include "tests/support/files/temporary_folder.hpp"

namespace deltamap::test {

inline Timestamp at_s(double time_s) {
  return timestamp_from_ns(1'700'000'000'000'000'000) + duration_from_seconds(time_s);
}

class SavingFixture : public testing::Test {
 protected:
  [[nodiscard]] daemon::RetryingOutput::Warn warn() {
    return [this](const std::string& line) { warnings.push_back(line); };
  }
  [[nodiscard]] daemon::OutputStatus status(const std::string& name) const {
    for (const daemon::OutputStatus& output : telemetry.outputs.all()) {
      if (output.name == name) return output;
    }
    ADD_FAILURE() << name << " is not on the board";
    return {};
  }

  TemporaryFolder folder;
  daemon::Telemetry telemetry;
  std::vector<std::string> warnings;
};

}  // namespace deltamap::test
