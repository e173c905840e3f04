// SPDX-License-Identifier: Apache-2.0
// A figure that a test has measured beside what it claims: printed as a line of its own, and kept in GoogleTest's
// report.
#pragma once

#include <gtest/gtest.h>

#include <cstdio>
#include <string>

namespace deltamap::test {

/// "figure worst_gap = 0.12 m"; the name is one word.
inline void tell_figure(const std::string& name, double value, const std::string& unit = "") {
  std::printf("figure %s = %.4g%s%s\n", name.c_str(), value, unit.empty() ? "" : " ", unit.c_str());
  testing::Test::RecordProperty(name, std::to_string(value) + (unit.empty() ? "" : " " + unit));
}

}  // namespace deltamap::test
