// SPDX-License-Identifier: Apache-2.0
#include "localization/belief/inlier_drop.hpp"

#include <gtest/gtest.h>

namespace deltamap::localization::belief {
namespace {

/// Shows it scans, ten a second.
class Scans {
 public:
  /// So many, all with these beams.
  void show(const BeamCounts& beams, int scans = 1) {
    Belief belief;
    belief.elsewhere = beams;
    for (int i = 0; i < scans; ++i) inlier_drop.observe(belief, at(++count_));
  }
  void be_silent(int scans) { count_ += scans; }

  InlierDropDetector inlier_drop;

 private:
  static Timestamp at(int scan) { return timestamp_from_ns(0) + duration_from_seconds(0.1 * scan); }

  int count_ = 0;
};

TEST(InlierDropDetector, CannotBeWorseThanBeforeWhereNothingWasKnownBefore) {
  Scans scans;
  scans.inlier_drop.remember();
  scans.show({.expected = 100, .fit = 50, .short_of = 50}, 50);
  EXPECT_FALSE(scans.inlier_drop.is_worse_than_remembered());
}

/// After 20 s in which all beams fit and a silence, a scan of which so many of 100 do.
bool is_worse_with(std::uint32_t fit) {
  Scans scans;
  scans.show({.expected = 100, .fit = 100}, 200);
  scans.inlier_drop.remember();
  scans.be_silent(50);
  scans.show({.expected = 100, .fit = fit, .short_of = 10, .beyond = 90 - fit});
  return scans.inlier_drop.is_worse_than_remembered();
}

TEST(InlierDropDetector, SeesThatTheMapFitsWorseAfterASilenceToo) {
  EXPECT_TRUE(is_worse_with(60));
  EXPECT_FALSE(is_worse_with(85)) << "a person may hide so much";
}

TEST(InlierDropDetector, HearsNothingFromAFewBeams) {
  Scans scans;
  scans.show({.expected = 100, .fit = 100}, 200);
  scans.inlier_drop.remember();
  scans.show({.expected = 29, .short_of = 29}, 50);
  EXPECT_FALSE(scans.inlier_drop.is_worse_than_remembered());
  scans.show({.expected = 30, .short_of = 30}, 10);
  EXPECT_TRUE(scans.inlier_drop.is_worse_than_remembered());
}

}  // namespace
}  // namespace deltamap::localization::belief
