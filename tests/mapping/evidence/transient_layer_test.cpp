// SPDX-License-Identifier: Apache-2.0
// The transient layer by itself, and as the evidence method fills it in a drawn hall.
#include "mapping/evidence/transient_layer.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "core/random.hpp"
#include "mapping/store_scan.hpp"
#include "tests/support/scans/drawn_scan.hpp"
#include "tests/support/worlds/drawn_hall.hpp"

namespace deltamap::mapping::evidence {
namespace {

constexpr int kCellsPerBlock = 2;
const GridGeometry kMap{40, 40, 0.05, {0.0, 0.0}};
const GridGeometry kBlocks{20, 20, 0.1, {0.0, 0.0}};

/// Keyframes, half a second apart.
class Layer {
 public:
  explicit Layer(const TransientLayerParams& params = {}) : layer{params, {kMap, kCellsPerBlock}} {}
  void added(const votes::Blocks& yes, const votes::Blocks& no = {}) {
    layer.observe({yes, no, {}, {}}, {}, now_ms += 500);
  }
  void removed(const votes::Blocks& yes, const votes::Blocks& no = {}) {
    layer.observe({{}, {}, yes, no}, {}, now_ms += 500);
  }
  [[nodiscard]] votes::Blocks standing() const { return layer.newest() ? layer.newest()->standing : votes::Blocks{}; }
  [[nodiscard]] votes::Blocks gone() const { return layer.newest() ? layer.newest()->gone : votes::Blocks{}; }

  TransientLayer layer;
  std::uint32_t now_ms = 1000;
};

TEST(TransientLayer, TakesInABlockAtItsSecondKeyframe) {
  Layer layer;
  layer.added({7, 30});
  EXPECT_TRUE(layer.standing().empty());
  layer.added({7});
  EXPECT_EQ(layer.standing(), votes::Blocks{7});
  layer.added({30});
  EXPECT_EQ(layer.standing(), (votes::Blocks{7, 30}));
}

TEST(TransientLayer, LetsGoOfABlockThatIsSeenThroughInFourKeyframesHoweverLongItStood) {
  Layer layer;
  for (int i = 0; i < 500; ++i) layer.added({7});
  for (int i = 0; i < 3; ++i) layer.added({}, {9, 7});
  EXPECT_EQ(layer.standing(), votes::Blocks{7});
  layer.added({}, {9, 7});
  EXPECT_TRUE(layer.standing().empty());
}

TEST(TransientLayer, KeepsWhatIsSeenAgainInBetween) {
  Layer layer;
  for (int i = 0; i < 20; ++i)
    layer.added(i % 3 == 2 ? votes::Blocks{} : votes::Blocks{7}, i % 3 == 2 ? votes::Blocks{7} : votes::Blocks{});
  EXPECT_EQ(layer.standing(), votes::Blocks{7});
}

TEST(TransientLayer, ForgetsWhatNobodyLooksAt) {
  Layer layer{{.least_votes = 2, .most_votes = 4, .lapse_s = 10.0}};
  for (int i = 0; i < 4; ++i) layer.added({7});
  for (int i = 0; i < 20; ++i) layer.added({50});
  EXPECT_EQ(layer.standing(), (votes::Blocks{7, 50}));
  layer.added({50});
  EXPECT_EQ(layer.standing(), votes::Blocks{50});
}

TEST(TransientLayer, KnowsWhatHasGoneUntilItIsSeenAgain) {
  Layer layer;
  for (int i = 0; i < 2; ++i) layer.removed({3, 4});
  EXPECT_EQ(layer.gone(), (votes::Blocks{3, 4}));
  EXPECT_TRUE(layer.standing().empty());
  for (int i = 0; i < 2; ++i) layer.removed({}, {4});
  EXPECT_EQ(layer.gone(), votes::Blocks{3});
}

TEST(TransientLayer, NeverHoldsMoreThanItsCapAndKeepsTheNewest) {
  Layer layer{{.least_votes = 1, .most_votes = 4, .lapse_s = 60.0, .most_blocks = 10}};
  for (std::uint32_t first = 0; first < 300; first += 4) {
    layer.added({first, first + 1, first + 2, first + 3});
    ASSERT_LE(layer.standing().size(), 10u);
  }
  EXPECT_EQ(layer.standing().size(), 10u);
  EXPECT_EQ(layer.standing().back(), 299u);
  EXPECT_EQ(layer.standing()[2], 292u);
}

TEST(TransientLayer, NamesEachSnapshotOnceAndMakesNoneWhereNothingChanges) {
  Layer layer;
  layer.added({});
  EXPECT_EQ(layer.layer.newest(), nullptr);
  for (int i = 0; i < 2; ++i) layer.added({7});
  const auto first = layer.layer.newest();
  EXPECT_EQ(first->number, 1u);
  for (int i = 0; i < 5; ++i) layer.added({7});
  EXPECT_EQ(layer.layer.newest(), first);
  for (int i = 0; i < 4; ++i) layer.added({}, {7});
  EXPECT_EQ(layer.layer.newest()->number, 2u);
  EXPECT_TRUE(layer.layer.newest()->empty());
}

TEST(TransientLayer, LeavesToTheMapWhatTheMapSays) {
  Layer layer;
  const auto at = [](int column, int row) { return static_cast<std::uint32_t>(kBlocks.index_of({column, row})); };
  for (int i = 0; i < 2; ++i)
    layer.layer.observe({votes::Blocks{at(5, 5), at(9, 9)}, {}, votes::Blocks{at(2, 12), at(3, 15)}, {}}, {}, 1);
  OccupancyGrid map{kMap, CellState::kFree};
  map.set({12, 10}, CellState::kOccupied);  // beside block (5, 5): drawn half a cell farther
  map.set({6, 31}, CellState::kOccupied);   // in block (3, 15): still there
  layer.layer.follow(map);
  layer.added({});
  EXPECT_EQ(layer.standing(), votes::Blocks{at(9, 9)});
  EXPECT_EQ(layer.gone(), votes::Blocks{at(3, 15)});
}

TEST(TransientLayer, TellsNobodyWhileThePoseIsInDoubtAndKnowsNothingOnceItWasWrong) {
  Layer layer;
  for (int i = 0; i < 3; ++i) layer.added({7});
  layer.layer.hide({});
  EXPECT_TRUE(layer.standing().empty());
  layer.added({});
  EXPECT_EQ(layer.standing(), votes::Blocks{7});
  layer.layer.clear();
  layer.added({});
  EXPECT_TRUE(layer.standing().empty());
}

/// A robot that stands in the hall and looks at what comes and goes.
class Lookout {
 public:
  explicit Lookout(MappingMethod method) : store{{.method = method}, 1} {}
  void look_at(const OccupancyGrid& world, double for_s) {
    for (const double end_s = time_s + for_s; time_s < end_s; time_s += 0.2) {
      const TrackedScan tracked = test::drawn_scan(world, map, {7.5, 6.8, 0.4}, time_s, random);
      writes = writes || store.observe(tracked).has_value();
    }
  }
  [[nodiscard]] bool stands_at(const Point2& place) const {
    return store.transients() != nullptr && store.transients()->stands_at(place);
  }

  std::shared_ptr<const OccupancyGrid> map = std::make_shared<const OccupancyGrid>(test::drawn_hall(0.05));
  StoreScan store;
  Random random{3};
  double time_s = 0.0;
  bool writes = false;
};

const Point2 kFace{10.02, 7.2};  // of somebody who stands in front of the robot

OccupancyGrid hall_with_somebody() {
  OccupancyGrid hall = test::drawn_hall(0.05);
  test::fill(hall, {10.0, 6.9}, {10.4, 7.5}, CellState::kOccupied);
  return hall;
}

TEST(TransientObstacles, HoldSomebodyWhoStopsWithinASecondAndAreNotMap) {
  Lookout lookout{MappingMethod::kEvidence};
  lookout.look_at(*lookout.map, 20.0);
  EXPECT_FALSE(lookout.stands_at(kFace));
  lookout.look_at(hall_with_somebody(), 1.2);
  EXPECT_TRUE(lookout.stands_at(kFace));
  lookout.look_at(hall_with_somebody(), 20.0);
  EXPECT_FALSE(lookout.writes);
}

TEST(TransientObstacles, LetSomebodyGoWithinThreeSeconds) {
  Lookout lookout{MappingMethod::kEvidence};
  lookout.look_at(*lookout.map, 20.0);
  lookout.look_at(hall_with_somebody(), 20.0);
  ASSERT_TRUE(lookout.stands_at(kFace));
  lookout.look_at(*lookout.map, 3.0);
  EXPECT_TRUE(lookout.store.transients()->standing.empty());
}

TEST(TransientObstacles, AreUnknownToThePapersMethod) {
  Lookout lookout{MappingMethod::kPaper};
  lookout.look_at(hall_with_somebody(), 10.0);
  EXPECT_EQ(lookout.store.transients(), nullptr);
}

}  // namespace
}  // namespace deltamap::mapping::evidence
