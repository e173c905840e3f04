// SPDX-License-Identifier: Apache-2.0
// Whether scans support a pose that a person gave. Says in the log when the first of them do not, and when nothing in
// the map has fitted for long: another map, a wrong mount, or a wrong pose. A person can mend these, and should hear of
// them at once.
#pragma once

#include <optional>
#include <string>

#include "core/messages.hpp"
#include "daemon/telemetry/log_line.hpp"
#include "localization/sensor/range_scale.hpp"

namespace deltamap::daemon {

/// "93 % of its beams fit", and what to look at where few do. `fit`: share of the beams that the map explains; nothing
/// where no beam came back.
[[nodiscard]] std::string fit_words(std::optional<double> fit);
/// So few fit that the pose may be wrong, or none can tell.
[[nodiscard]] bool is_in_doubt(std::optional<double> fit);

/// Of a start pose that is not near free floor (localization/particles/start_pose.hpp).
[[nodiscard]] LogLine refused_start_line();

class FitWatch {
 public:
  /// `is_given`: the run begins at a pose that a person gave.
  explicit FitWatch(bool is_given) : given_{is_given ? std::optional{Given{}} : std::nullopt} {}

  struct Seen {
    std::optional<double> fit;                                ///< as Localizer::fit()
    std::optional<double> fit_of_all;                         ///< as Localizer::fit_of_all()
    std::optional<localization::sensor::OtherScale> scale{};  ///< as Localizer::range_scale()
  };
  /// After each scan: a line for the log, of no text where there is nothing to say.
  [[nodiscard]] LogLine observe(const TrackedScan& tracked, const Seen& seen);
  /// False from the moment at which a person gave a pose until the scans since then support it, or it is called right.
  /// What the first scan supports, the next ones may still refute.
  [[nodiscard]] bool start_fits() const { return !given_ || given_->is_supported; }
  /// It has said that ranges and map differ in scale.
  [[nodiscard]] bool is_scale_told() const { return is_scale_told_; }
  /// A person has said where the robot stands: only scans from now on speak for that.
  void relocalized() {
    given_ = Given{};
    mean_fit_.reset();
  }

 private:
  /// A pose that was given and that scans have yet to prove.
  struct Given {
    int scans = 0;     // with a return
    double fit = 0.0;  // their plain mean at first, then a running one
    bool is_supported = false;
    bool is_told = false;  // that it does not fit
  };
  [[nodiscard]] LogLine judged_start(std::optional<double> fit_of_all, PoseVerdict verdict);
  [[nodiscard]] LogLine judged_scale(const std::optional<localization::sensor::OtherScale>& scale);
  [[nodiscard]] LogLine judged_long(LocalizerState state);
  void pass(const TrackedScan& tracked);

  std::optional<Given> given_;  // nothing: none was, or it has proven right
  std::optional<double> mean_fit_;
  std::optional<Timestamp> last_;
  Pose2 last_odom_from_robot_;
  double passed_s_ = 0.0;  // since the last scan
  double driven_m_ = 0.0;  // since the last scan
  double unfit_s_ = 0.0;   // unbroken
  double unfit_m_ = 0.0;   // driven meanwhile
  bool said_ = false;
  bool is_scale_told_ = false;
};

}  // namespace deltamap::daemon
