// SPDX-License-Identifier: Apache-2.0
// Figure 1 of the paper closed: localizer, store-scan, alignment and merge on one drive; each M_k goes back to the
// localizer.
#include <gtest/gtest.h>

#include <cstdio>
#include <memory>

#include "mapping/map_update.hpp"
#include "mapping/map_update_params.hpp"
#include "mapping/paper/divergence_ratio.hpp"
#include "mapping/registration/contour_score.hpp"
#include "mapping/store_scan.hpp"
#include "tests/support/scans/hall_drive.hpp"
#include "tests/support/scans/map_requests.hpp"
#include "tests/support/worlds/changed_hall.hpp"

namespace deltamap::mapping {
namespace {

TEST(UpdateLoop, BringsTheMapNearerToTheChangedHallAndKeepsTheRobotInIt) {
  const OccupancyGrid before = test::drawn_hall(0.05);
  const OccupancyGrid after = test::changed_hall();
  OccupancyGrid map = before;
  test::HallDrive drive{before, {1.5, 1.0, 0.0}, 31};
  StoreScanParams params;
  params.method = MappingMethod::kPaper;
  StoreScan store{params, 31};
  paper::DivergenceRatio ratio{{}};
  std::uint32_t revision = 0;
  double most_error_m = 0.0;
  for (int lap = 0; lap < 4; ++lap) {
    for (const Point2& place : test::way_round()) {
      drive.drive_to(place, lap == 0 ? before : after, [&](const TrackedScan& tracked) {
        most_error_m = std::max(most_error_m, distance_between(tracked.estimate.map_from_robot, drive.truth()));
        TrackedScan weighed = tracked;
        weighed.weights = ratio.observe(tracked.estimate);
        const auto set = test::set_in(store.observe(weighed));
        if (!set) return;
        scan_set::MapUpdate update = map_update(map, *set, {});
        std::printf("lap %d: %zu scans, acceptance %.3f, %s, %zu cells\n", lap, set->scans.size(), update.acceptance,
                    std::string{name_of(update.refusal)}.c_str(), update.changes.size());
        if (!update.accepted()) return;
        map = patched(map, update.changes);
        MapRevision next{++revision, set->ended, std::make_shared<const OccupancyGrid>(map), update.changes, {}};
        next.field_patch = localization::prepared_field_patch(test::HallDrive::params(), map, next.changes);
        drive.localizer().apply(next);
      });
    }
  }
  const double stale = registration::contour_score(after, before).f1();
  const double updated = registration::contour_score(after, map).f1();
  std::printf("contour F1 %.3f -> %.3f in %u revisions, error at most %.2f m\n", stale, updated, revision,
              most_error_m);
  EXPECT_GE(revision, 1U);
  EXPECT_GT(updated, stale);
  EXPECT_LT(most_error_m, 0.3);
}

}  // namespace
}  // namespace deltamap::mapping
