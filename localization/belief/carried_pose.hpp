// SPDX-License-Identifier: Apache-2.0
// Do wheels and scans carry the pose on from where it was surely right? Where people and goods fill the view the map
// explains hardly a beam, and each scan alone speaks against the pose. But scans that go on from those before, and
// wheels that say the same, have led here: what the map does not explain then is new, the pose is not wrong.
#pragma once

#include <optional>

namespace deltamap::localization::belief {

class CarriedPose {
 public:
  /// From one scan to the next.
  struct Step {
    bool is_continued = false;  ///< by wheels that have not begun anew, without a gap
    bool fits_before = false;   ///< the scan fits what the last metres have shown, where the wheels tell
    double driven_m = 0.0;
  };
  void observe(const Step& step);
  void start_from_here() { since_m_ = 0.0; }
  void end() { since_m_.reset(); }

  [[nodiscard]] bool is_carried() const;

 private:
  std::optional<double> since_m_;  // driven since the pose was surely right
};

}  // namespace deltamap::localization::belief
