// SPDX-License-Identifier: Apache-2.0
// Runs the `deltamap` tool inside a test, as from the command line, and keeps what it said.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "daemon/tool/run_tool.hpp"

namespace deltamap::test {

struct ToolRun {
  int exit_code = 0;
  std::string output;
  std::string errors;
};

/// `words` are what follows `deltamap`.
[[nodiscard]] inline ToolRun run_deltamap(const std::vector<std::string>& words) {
  std::vector<const char*> arguments{"deltamap"};
  for (const std::string& word : words) arguments.push_back(word.c_str());
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  ToolRun run;
  run.exit_code = daemon::tool::run_tool(static_cast<int>(arguments.size()), arguments.data());
  run.output = testing::internal::GetCapturedStdout();
  run.errors = testing::internal::GetCapturedStderr();
  return run;
}

}  // namespace deltamap::test
