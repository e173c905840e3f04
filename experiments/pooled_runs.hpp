// SPDX-License-Identifier: Apache-2.0
// Numbers that are made of the rows of several runs together, and how sure each is: whole runs are drawn again, for the
// rows of one run are like each other.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "experiments/experiment.hpp"

namespace deltamap::experiments {

/// The outcomes with all these labels.
[[nodiscard]] std::vector<const Outcome*> runs_with(const std::vector<Outcome>& outcomes,
                                                    const std::vector<std::pair<std::string, std::string>>& labels);

/// The rows of all of them, one after another.
[[nodiscard]] ScanTable rows_of(const std::vector<const Outcome*>& runs);

/// A run's pictures into the report, each title after `where` and the run's seed.
void add_pictures(Report& report, const std::string& where, const Outcome& run);

class PooledRuns {
 public:
  using Numbers = std::vector<std::pair<std::string, double>>;

  /// The runs must outlive this.
  PooledRuns(std::vector<const Outcome*> runs, const std::function<Numbers(const ScanTable&)>& numbers_of);

  [[nodiscard]] bool empty() const { return runs_.empty(); }
  [[nodiscard]] const std::vector<const Outcome*>& runs() const { return runs_; }
  [[nodiscard]] double number(const std::string& name) const { return all_.number(name); }
  [[nodiscard]] Figure figure(const std::string& name, const std::string& number, const std::string& unit = "",
                              const std::optional<Target>& target = {}, const std::string& peers = "") const;
  /// A figure that is a count, a least or a most: without an interval.
  [[nodiscard]] Figure figure_of_extreme(const std::string& name, const std::string& number,
                                         const std::string& unit = "", const std::optional<Target>& target = {},
                                         const std::string& peers = "") const;

 private:
  std::vector<const Outcome*> runs_;
  Outcome all_;
  std::vector<Certainty> certainties_;  // of all_.numbers
};

}  // namespace deltamap::experiments
