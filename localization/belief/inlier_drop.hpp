// SPDX-License-Identifier: Apache-2.0
// Tells whether fewer beams end where the map expects them than before a moment that it was told to remember: whether
// the map fits worse since then.
#pragma once

#include <optional>

#include "core/messages.hpp"

namespace deltamap::localization::belief {

class InlierDropDetector {
 public:
  /// Every scan in order. Shares are averaged over time: what the last checked scan has told holds until the next one.
  void observe(const Belief& belief, Timestamp time);

  /// What is usual now is what has to come back; nothing where that is not known yet: a moment is no usual view.
  void remember();
  void forget() { remembered_.reset(); }
  /// Another pose is believed: that it fits as usual is believed too, until scans have been seen from it.
  void start() { present_ = remembered_.value_or(usual_); }
  /// Do fewer beams fit than was usual when it was remembered, by more than kMostDrop?
  [[nodiscard]] bool is_worse_than_remembered() const;

 private:
  std::optional<Timestamp> last_;
  double known_for_s_ = 0.0;
  double usual_ = 0.0;    // share of the beams that do not fit,
  double present_ = 0.0;  // and now
  std::optional<double> remembered_;
};

}  // namespace deltamap::localization::belief
