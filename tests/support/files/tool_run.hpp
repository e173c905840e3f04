// SPDX-License-Identifier: Apache-2.0
// Runs the `deltamap` tool inside a test, as from the command line, and keeps what it said.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/support/files/source_tree.hpp"
#include "tool/run_tool.hpp"

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
  run.exit_code = tool::run_tool(static_cast<int>(arguments.size()), arguments.data());
  run.output = testing::internal::GetCapturedStdout();
  run.errors = testing::internal::GetCapturedStderr();
  return run;
}

/// One seed of an experiment on the project's own scenarios; `more` options follow.
[[nodiscard]] inline ToolRun run_experiment(const std::string& name, const std::string& out, const std::string& minutes,
                                            const std::vector<std::string>& more) {
  std::vector<std::string> words{
      "experiment", name,    "--out",     out, "--scenarios", test::source_path("config/scenarios"),
      "--minutes",  minutes, "--repeats", "1"};
  words.insert(words.end(), more.begin(), more.end());
  return run_deltamap(words);
}

}  // namespace deltamap::test
