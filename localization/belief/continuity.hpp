// SPDX-License-Identifier: Apache-2.0
// Has the believed pose been followed without a break? A robot that is carried goes on believing where its wheels say
// it is. Its scans break off there, and afterwards the map fits worse: a break alone may be a thing that somebody has
// moved. From then on the pose has to be found right anew by what is in view, and as much has to fit as before. Another
// hypothesis alone does not break it: where things have been moved together, the pose that follows them fits best.
#pragma once

#include <optional>

#include "core/messages.hpp"
#include "localization/belief/inlier_drop.hpp"
#include "localization/belief/scan_break.hpp"

namespace deltamap::localization::belief {

class Continuity {
 public:
  explicit Continuity(const ScanBreakParams& params) : scan_break_{params} {}

  /// A pose is believed anew. What has carried the robot is still remembered: there, too, as much has to fit as before.
  void start() {
    inlier_drop_.start();
    is_unbroken_ = true;
    followed_s_ = 0.0;
  }

  /// Every scan in order, with what is believed without it. True at the scan that tells that the robot was carried.
  [[nodiscard]] bool observe(const FollowedScan& scan, const Belief& believed, bool is_tracking);

  [[nodiscard]] bool is_unbroken() const { return is_unbroken_; }
  /// The robot was carried, by all signs: scans broke off, and the map fits worse than before.
  [[nodiscard]] bool fits_worse() const { return suspected_since_ && inlier_drop_.is_worse_than_remembered(); }
  /// The last scan at a tracked pose that did not follow from the one before.
  [[nodiscard]] const std::optional<Timestamp>& broke_off_at() const { return broke_off_at_; }
  /// Has one of the scans of the last minutes not followed from the one before, or did none tell? A robot that was
  /// carried then might still be believed where it was.
  [[nodiscard]] bool may_have_been_kidnapped() const;

 private:
  void forget_suspicion();

  ScanBreak scan_break_;
  InlierDropDetector inlier_drop_;
  std::optional<Timestamp> broke_off_at_;
  std::optional<Timestamp> suspected_since_;  ///< the last break, or the one after which the map fitted worse
  bool was_kidnapped_ = false;                ///< it did fit worse since then
  bool is_unbroken_ = true;
  double followed_s_ = 0.0;  ///< so long each scan of the tracked pose has followed from the one before
};

}  // namespace deltamap::localization::belief
