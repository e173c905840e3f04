// SPDX-License-Identifier: Apache-2.0
// What a chart of a report shows.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace deltamap::reports {

struct Series {
  std::string name;
  std::vector<std::pair<double, double>> points;
};

struct Chart {
  std::string title;
  std::string x;
  std::string y;
  std::vector<Series> series{};
  bool with_diagonal = false;  ///< y = x, for reliability
};

}  // namespace deltamap::reports
