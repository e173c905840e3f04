// SPDX-License-Identifier: Apache-2.0
// Says in the log when the pose that the run was given does not fit the first scans, and when nothing in the map has
// fitted for long: another map, a wrong mount, or a wrong pose. A person can mend these, and should hear of them at
// once.
#pragma once

#include <optional>
#include <string>

#include "core/messages.hpp"
#include "daemon/telemetry/log_line.hpp"

namespace deltamap::daemon {

// `fit`: share of the beams that the map explains; nothing where no beam came back.

/// "93 % of its beams fit", and what to look at where few do.
[[nodiscard]] std::string fit_words(std::optional<double> fit);
/// So few fit that the pose may be wrong, or none can tell.
[[nodiscard]] bool is_in_doubt(std::optional<double> fit);

/// Of a start pose that is not near free floor (localization/particles/start_pose.hpp).
[[nodiscard]] LogLine refused_start_line();

class FitWatch {
 public:
  /// `is_given`: the run begins at a pose that a person gave.
  explicit FitWatch(bool is_given) : looks_at_start_{is_given} {}

  /// After each scan: a line for the log, of no text where there is nothing to say.
  /// `fit`: share of its beams that the map explains at the estimated pose; nothing where no beam came back.
  [[nodiscard]] LogLine observe(const TrackedScan& tracked, std::optional<double> fit);
  /// False from the first scans, which the given pose does not fit, until others have fitted or the pose has been
  /// called right; and from the pose that a person gave until its scan has fitted.
  [[nodiscard]] bool start_fits() const { return !start_is_unfit_; }
  /// A person has said where the robot stands, and the next scan fits there or does not.
  void relocalized(std::optional<double> fit) { start_is_unfit_ = is_in_doubt(fit); }

 private:
  [[nodiscard]] LogLine judged_start();
  [[nodiscard]] LogLine judged_long(LocalizerState state);
  void pass(const TrackedScan& tracked);

  bool looks_at_start_;
  bool start_is_unfit_ = false;
  int first_scans_ = 0;
  double first_fit_ = 0.0;  // sum over them
  std::optional<double> mean_fit_;
  std::optional<Timestamp> last_;
  Pose2 last_odom_from_robot_;
  double passed_s_ = 0.0;  // since the last scan
  double driven_m_ = 0.0;  // since the last scan
  double unfit_s_ = 0.0;   // unbroken
  double unfit_m_ = 0.0;   // driven meanwhile
  bool said_ = false;
};

}  // namespace deltamap::daemon
