// SPDX-License-Identifier: Apache-2.0
#include "experiments/scan_table.hpp"

#include <algorithm>
#include <cassert>

namespace deltamap::experiments {

void ScanTable::add(const std::vector<double>& row) {
  assert(row.size() == columns_.size() && "a row has a value for every column");
  values_.insert(values_.end(), row.begin(), row.end());
}

std::size_t ScanTable::index_of(std::string_view column) const {
  const auto found = std::find(columns_.begin(), columns_.end(), column);
  assert(found != columns_.end() && "the column exists");
  return static_cast<std::size_t>(found - columns_.begin());
}

std::vector<double> ScanTable::column(std::string_view name) const {
  if (rows() == 0) return {};
  const std::size_t index = index_of(name);
  std::vector<double> values(rows());
  for (std::size_t row = 0; row < values.size(); ++row) values[row] = at(row, index);
  return values;
}

void append(std::vector<double>& values, const std::vector<double>& more) {
  values.insert(values.end(), more.begin(), more.end());
}

}  // namespace deltamap::experiments
