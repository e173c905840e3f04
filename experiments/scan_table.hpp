// SPDX-License-Identifier: Apache-2.0
// Numbers of a drive, a row for every scan.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/statistics/summary.hpp"
#include "reports/number_text.hpp"

namespace deltamap::experiments {

class ScanTable {
 public:
  ScanTable() = default;
  explicit ScanTable(std::vector<std::string> columns) : columns_{std::move(columns)} {}

  /// As many as there are columns.
  void add(const std::vector<double>& row);
  [[nodiscard]] std::size_t rows() const { return columns_.empty() ? 0 : values_.size() / columns_.size(); }
  [[nodiscard]] const std::vector<std::string>& columns() const { return columns_; }
  [[nodiscard]] std::vector<double> column(std::string_view name) const;
  [[nodiscard]] double at(std::size_t row, std::size_t column) const { return values_[row * columns_.size() + column]; }
  [[nodiscard]] std::size_t index_of(std::string_view column) const;

 private:
  std::vector<std::string> columns_;
  std::vector<double> values_;
};

using reports::text_of;

void append(std::vector<double>& values, const std::vector<double>& more);

}  // namespace deltamap::experiments
