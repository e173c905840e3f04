// SPDX-License-Identifier: Apache-2.0
// Runs `deltamap-lab` inside a test, as from the command line, and keeps what it said.
#pragma once

#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>

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

/// "drive: figure, of which runs" to its value, of an experiment that was told --json.
[[nodiscard]] inline std::map<std::string, double> figures_of(const ToolRun& answer) {
  EXPECT_EQ(answer.exit_code, 0) << answer.errors;
  std::map<std::string, double> figures;
  if (answer.exit_code != 0) return figures;
  const auto summary = nlohmann::json::parse(answer.output);
  for (const auto& figure : summary["figures"]) {
    if (figure["value"].is_number()) figures.emplace(figure["name"].get<std::string>(), figure["value"].get<double>());
  }
  return figures;
}

}  // namespace deltamap::test
