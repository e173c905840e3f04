// SPDX-License-Identifier: Apache-2.0
// Eq. 11 on halls: what it says, and what it hides.
#include <gtest/gtest.h>

#include "mapping/registration/acceptance.hpp"
#include "mapping/registration/contour_score.hpp"
#include "tests/support/worlds/changed_hall.hpp"

namespace deltamap::mapping {
namespace {

TEST(Equation11, IsAgreementOverAgreementAndDisagreement) {
  const OccupancyGrid before = test::drawn_hall(0.05);
  const OccupancyGrid after = test::changed_hall();
  std::size_t same = 0;
  std::size_t different = 0;
  for (std::size_t i = 0; i < before.geometry().cell_count(); ++i) {
    const Cell cell = before.geometry().cell_of(i);
    if (before[cell] == CellState::kUnknown || after[cell] == CellState::kUnknown) continue;
    ++(before[cell] == after[cell] ? same : different);
  }
  const registration::Acceptance counts = registration::acceptance(before, after);
  EXPECT_EQ(counts.agreeing, same);
  EXPECT_EQ(counts.disagreeing, different);
  EXPECT_DOUBLE_EQ(counts.value(), static_cast<double>(same) / static_cast<double>(same + different));
  EXPECT_DOUBLE_EQ(registration::acceptance(after, before).value(), counts.value());
  EXPECT_DOUBLE_EQ(registration::acceptance(after, after).value(), 1.0);
}

TEST(Equation11, HardlyNoticesAMapThatIsNeverUpdated) {
  const OccupancyGrid stale = test::drawn_hall(0.05);
  const OccupancyGrid truth = test::changed_hall();
  EXPECT_GT(registration::acceptance(stale, truth).value(), 0.95) << "three containers are wrong";
  EXPECT_LT(registration::contour_score(truth, stale).f1(), 0.93);
}

}  // namespace
}  // namespace deltamap::mapping
