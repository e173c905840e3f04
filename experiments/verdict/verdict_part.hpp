// SPDX-License-Identifier: Apache-2.0
// Some of the runs of `verdict`, and what they have in common.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "experiments/experiment.hpp"
#include "experiments/verdict/verdict_score.hpp"

namespace deltamap::experiments {

/// Whether another place of the map fits the run's path as well.
[[nodiscard]] inline bool is_ambiguous(const Outcome& run) { return run.number("ambiguous") > 0.5; }

class VerdictPart {
 public:
  /// The runs that belong, by a claim about an Outcome. They must outlive this.
  template <typename Belongs>
  VerdictPart(const std::vector<Outcome>& outcomes, Belongs&& belongs) {
    for (const Outcome& outcome : outcomes) {
      if (belongs(outcome)) chosen_.push_back(&outcome);
    }
  }

  explicit VerdictPart(std::vector<const Outcome*> chosen) : chosen_{std::move(chosen)} {}
  [[nodiscard]] const std::vector<const Outcome*>& chosen() const { return chosen_; }

  // Counts of runs.
  [[nodiscard]] double runs() const { return static_cast<double>(chosen_.size()); }
  [[nodiscard]] double once_wrong() const;
  [[nodiscard]] double ambiguous() const;
  [[nodiscard]] double wrong_called_right() const;                     ///< for more than 5 s unbroken
  [[nodiscard]] double right_called_lost() const;                      ///< of those that never were wrong
  [[nodiscard]] double recovered_in(double driving_s) const;           ///< of the once wrong
  [[nodiscard]] double called_right_again_in(double driving_s) const;  ///< and called right by then

  /// Of the once wrong, counted from when the path had become unambiguous.
  [[nodiscard]] double recovered_in_after_unique(double driving_s) const;

  /// Driving until a wrong pose has recovered, s; those that never do are as late as can be: NaN.
  [[nodiscard]] double recovery_quantile_s(double share) const;
  /// Until a wrong pose was not called right, s.
  [[nodiscard]] double mean_noticed_s() const;
  /// Share of the time, of runs that never were wrong.
  [[nodiscard]] double called_right_when_right() const;
  [[nodiscard]] Reliability pose() const;
  [[nodiscard]] Reliability map() const;

 private:
  std::vector<const Outcome*> chosen_;
};

}  // namespace deltamap::experiments
