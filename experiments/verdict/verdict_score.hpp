// SPDX-License-Identifier: Apache-2.0
// What a run of `verdict` has shown. A pose is right within 0.3 m and 6° of the truth and wrong beyond 0.5 m or 10°;
// between, it counts for neither. It is called right by the verdict, and called lost by the state or the verdict.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "experiments/scan_table.hpp"

namespace deltamap::experiments {

enum class PoseTruth { kRight, kBetween, kWrong };
[[nodiscard]] PoseTruth pose_truth(double error_m, double heading_error_rad);

/// Numbers of one run, of the scans since the event (`driven_s`: driving since the event):
/// was_wrong, wrong_called_right_s (longest unbroken), right_called_lost_s (of a pose that never was wrong),
/// noticed_s (until a wrong pose was not called right; NaN: never wrong, or never noticed),
/// recovered_s (from the first wrong scan to the first scan after the last wrong one with which 5 s unbroken begin of
/// a right pose that is tracked; NaN: never wrong, or not recovered) and recovered_driving_s (the driving within that),
/// recovered_called_right_s (driving from the first wrong scan until right, tracked and called right; NaN: never),
/// ends_wrong, ends_called_right, pose_brier and map_brier with their scans.
[[nodiscard]] std::vector<std::pair<std::string, double>> verdict_numbers(const ScanTable& scans);

/// How often what was given a probability came true: ten bins, for each the mean probability and the share.
struct Reliability {
  struct Bin {
    double scans = 0.0;
    double given = 0.0;  ///< sum of probabilities
    double came = 0.0;
  };
  std::vector<Bin> bins = std::vector<Bin>(10);
  double squared = 0.0;  ///< sum of (given - came)²
  double scans = 0.0;

  void take(double given, bool came);
  [[nodiscard]] double brier() const { return squared / scans; }
};
[[nodiscard]] Reliability pose_reliability(const ScanTable& scans, Reliability before = {});
[[nodiscard]] Reliability map_reliability(const ScanTable& scans, Reliability before = {});

}  // namespace deltamap::experiments
