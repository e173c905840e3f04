// SPDX-License-Identifier: Apache-2.0
#include "simulation/score/number_lines.hpp"

#include <algorithm>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace deltamap::simulation::score {

std::vector<std::array<double, 8>> number_lines(const std::filesystem::path& file, const std::string& what,
                                                const std::string& columns) {
  std::ifstream in(file);
  if (!in || std::filesystem::is_directory(file)) throw std::runtime_error(file.string() + ": cannot be read");
  std::vector<std::array<double, 8>> lines;
  int number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    if (line.empty() || line.front() == '#') continue;
    std::istringstream fields(line);
    std::array<double, 8> values{};
    if (!std::all_of(values.begin(), values.end(), [&](double& value) { return !!(fields >> value); })) {
      std::ostringstream error;
      error << file.string() << ": line " << number << ": not a " << what << " (" << columns << ')';
      throw std::runtime_error(error.str());
    }
    lines.push_back(values);
  }
  if (lines.empty()) throw std::runtime_error(file.string() + ": line 1: holds no " + what);
  return lines;
}

}  // namespace deltamap::simulation::score
