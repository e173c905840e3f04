// SPDX-License-Identifier: Apache-2.0
// What a scan shows of glass, of stretch wrap and of posts narrower than the beam.
#include "simulation/robot/surface_optics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "simulation/scenario/start_map.hpp"
#include "tests/simulation/robot/perfect_laser.hpp"

namespace deltamap::simulation {
namespace {

const Object kHall{1, ObjectKind::kWall, Polyline{{{0, 0}, {40, 0}, {40, 20}, {0, 20}, {0, 0}}}};
constexpr double kSameRange_m = 1e-5;

std::vector<Reading> measured(const World& world, const RangeFinderParams& params, const Pose2& map_from_robot,
                              const std::vector<double>& bearings_rad, std::uint64_t seed = 1) {
  RangeFinder laser{params, Random{seed}};
  const RayCaster surfaces{world};
  const Sweep sweep{bearings_rad, std::vector<double>(bearings_rad.size(), 0.0)};
  return laser.measure(
      sweep, 80.0, surfaces, [&](double) { return map_from_robot; }, [](double) { return MovingSurfaces{}; });
}

World with_pane() { return {{kHall, {2, ObjectKind::kWall, Polyline{{{10, 0}, {10, 20}}}, Material::kGlass}}}; }

World with_pallet() { return {{kHall, {2, ObjectKind::kContainer, Box{{10, 10}, 1, 4, 0}, Material::kWrap}}}; }

TEST(Glass, ReturnsABeamThatMeetsItAtARightAngleAndLetsAllElseThrough) {
  const auto readings =
      measured(with_pane(), perfect_laser(), {5, 10, 0}, {0.0, radians(3.5), radians(4.5), radians(30)});
  EXPECT_NEAR(readings[0].range_m, 5.0, kSameRange_m);
  EXPECT_NEAR(readings[1].range_m, 5.0 / std::cos(radians(3.5)), kSameRange_m);
  EXPECT_NEAR(readings[2].range_m, 35.0 / std::cos(radians(4.5)), kSameRange_m) << "the wall behind it";
  EXPECT_NEAR(readings[3].range_m, 10.0 / std::sin(radians(30)), kSameRange_m);
}

TEST(Glass, ShowsNothingWhereNothingLiesBehindItInReach) {
  World world = with_pane();
  world.objects[0].shape = Polyline{{{0, 0}, {0, 20}}};
  EXPECT_EQ(measured(world, perfect_laser(), {5, 10, 0}, {radians(20)})[0].kind, BeamKind::kBeyondMaximum);
}

TEST(Glass, StandsInTheFirstMapOrNotAsTheScenarioSaysAndHidesNoFloor) {
  World world = with_pane();
  for (const bool drawn : {true, false}) {
    world.objects[1].is_drawn = drawn;
    const OccupancyGrid map = start_map(world, {5, 10}, 0.05);
    EXPECT_EQ(map.at(map.geometry().cell_at({10, 10})), drawn ? CellState::kOccupied : CellState::kFree);
    EXPECT_EQ(map.at(map.geometry().cell_at({20, 10})), CellState::kFree);
  }
}

TEST(StretchWrap, SharesItsBeamsBetweenReturnedLostThroughDazzledAndShort) {
  constexpr std::size_t kBeams = 20'000;
  constexpr double kShareTolerance = 0.01;
  RangeFinderParams params = perfect_laser();
  params.surfaces = {.wrap_no_return_share = 0.2,
                     .wrap_through_share = 0.1,
                     .wrap_dazzle_share = 0.05,
                     .wrap_short_share = 0.15,
                     .wrap_short_m = 0.3};
  std::map<std::string, double> share;
  for (const Reading& reading : measured(with_pallet(), params, {5, 10, 0}, std::vector<double>(kBeams, 0.0))) {
    const bool is_range = reading.kind == BeamKind::kRange;
    if (reading.kind == BeamKind::kNotValid) share["lost"] += 1.0 / kBeams;
    if (reading.kind == BeamKind::kDazzled) share["dazzled"] += 1.0 / kBeams;
    if (is_range && std::abs(reading.range_m - 4.5) < kSameRange_m) share["returned"] += 1.0 / kBeams;
    if (is_range && std::abs(reading.range_m - 35.0) < kSameRange_m) share["through"] += 1.0 / kBeams;
    if (is_range && reading.range_m >= 4.2 && reading.range_m < 4.5 - kSameRange_m) share["short"] += 1.0 / kBeams;
  }
  EXPECT_NEAR(share["lost"], 0.2, kShareTolerance);
  EXPECT_NEAR(share["through"], 0.1, kShareTolerance);
  EXPECT_NEAR(share["dazzled"], 0.05, kShareTolerance);
  EXPECT_NEAR(share["short"], 0.15, kShareTolerance);
  EXPECT_NEAR(share["returned"], 0.5, kShareTolerance);
}

TEST(StretchWrap, GivesTheSameReadingsForTheSameSeedOnly) {
  const std::vector<double> bearings(200, 0.0);
  const auto ranges = [&](std::uint64_t seed) {
    std::vector<double> found;
    for (const Reading& reading : measured(with_pallet(), perfect_laser(), {5, 10, 0}, bearings, seed))
      found.push_back(reading.range_m);
    return found;
  };
  EXPECT_EQ(ranges(1), ranges(1));
  EXPECT_NE(ranges(1), ranges(2));
}

TEST(StretchWrap, StaysOnAPalletThatIsPushed) {
  const World world = changed(with_pallet(), {ChangeKind::kShifted, 2, Box{{11, 10}, 1, 4, 0}, Box{{10, 10}, 1, 4, 0}});
  EXPECT_EQ(world.find(2)->material, Material::kWrap);
}

/// Share of the beams towards a post of 8 cm that read it, the bearings spread evenly over half a degree.
double share_on_post(double distance_m) {
  const World world{{kHall, {2, ObjectKind::kPost, Box{{2.0 + distance_m, 10}, 0.08, 0.08, 0}}}};
  std::vector<double> bearings;
  for (int i = 0; i < 500; ++i) bearings.push_back(radians(-0.25 + 0.001 * i));
  double share = 0.0;
  for (const Reading& reading : measured(world, perfect_laser(), {2, 10, 0}, bearings)) {
    if (std::abs(reading.range_m - distance_m + 0.04) < 0.05) share += 1.0 / 500.0;
  }
  return share;
}

TEST(ThinPost, IsReadByEveryBeamOfWhichHalfFallsOnIt) {
  constexpr double kInnerHalf_deg = 0.125;  // of the cone of 0.25°
  for (const double distance_m : {10.0, 15.0, 20.0, 30.0}) {
    const double post_deg = degrees(0.08 / (distance_m - 0.04));
    const double expected = std::min(1.0, (post_deg + kInnerHalf_deg) / 0.5);
    EXPECT_NEAR(share_on_post(distance_m), expected, 0.02) << distance_m;
  }
}

}  // namespace
}  // namespace deltamap::simulation
