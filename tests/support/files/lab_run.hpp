// SPDX-License-Identifier: Apache-2.0
// Runs `deltamap-lab` inside a test, as from the command line, and keeps what it said.
#pragma once

#include "tests/support/files/source_tree.hpp"
#include "tests/support/files/tool_run.hpp"
#include "tool/lab/run_lab.hpp"

namespace deltamap::test {

[[nodiscard]] inline ToolRun run_lab(const std::vector<std::string>& words) {
  return run_program(tool::run_lab, "deltamap-lab", words);
}

/// One seed of an experiment on the project's own scenarios; `more` options follow.
[[nodiscard]] inline ToolRun run_experiment(const std::string& name, const std::string& out, const std::string& minutes,
                                            const std::vector<std::string>& more) {
  std::vector<std::string> words{
      name, "--out", out, "--scenarios", test::source_path("config/scenarios"), "--minutes", minutes, "--repeats", "1"};
  words.insert(words.end(), more.begin(), more.end());
  return run_lab(words);
}

}  // namespace deltamap::test
