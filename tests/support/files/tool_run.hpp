// SPDX-License-Identifier: Apache-2.0
// Runs the `deltamap` tool inside a test, as from the command line, and keeps what it said.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tool/run_tool.hpp"

namespace deltamap::test {

struct ToolRun {
  int exit_code = 0;
  std::string output;
  std::string errors;
};

/// `words` are what follows the program's name.
[[nodiscard]] inline ToolRun run_program(int (&program)(int, const char* const*), const char* name,
                                         const std::vector<std::string>& words) {
  std::vector<const char*> arguments{name};
  for (const std::string& word : words) arguments.push_back(word.c_str());
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  ToolRun run;
  run.exit_code = program(static_cast<int>(arguments.size()), arguments.data());
  run.output = testing::internal::GetCapturedStdout();
  run.errors = testing::internal::GetCapturedStderr();
  return run;
}

[[nodiscard]] inline ToolRun run_deltamap(const std::vector<std::string>& words) {
  return run_program(tool::run_tool, "deltamap", words);
}

}  // namespace deltamap::test
