// SPDX-License-Identifier: Apache-2.0
#include "daemon/dashboard/places.hpp"

#include <gtest/gtest.h>

namespace deltamap::daemon::dashboard {
namespace {

/// Guests with places for four, three of them for one address.
class PlacesTest : public testing::Test {
 protected:
  void add(const std::string& from, Standing standing = Standing::kWaits, bool is_known = false) {
    guests_.push_back({from, is_known, standing, guests_.size()});
  }
  [[nodiscard]] std::vector<const Guest*> all() const {
    std::vector<const Guest*> pointers;
    for (const Guest& guest : guests_) pointers.push_back(&guest);
    return pointers;
  }
  [[nodiscard]] Welcome welcome(const std::string& from) const { return welcome_for(from, all(), {4, 3}); }
  /// Index of who leaves for one more; -1: there is room, -2: not welcome.
  [[nodiscard]] int leaves(const std::string& from) const {
    const Welcome verdict = welcome(from);
    if (!verdict.is_welcome) return -2;
    return verdict.leaves == nullptr ? -1 : static_cast<int>(verdict.leaves->since);
  }

  std::vector<Guest> guests_;
};

TEST_F(PlacesTest, NobodyLeavesWhileThereIsRoom) {
  EXPECT_EQ(leaves("a"), -1);
  for (const char* from : {"a", "b", "c"}) add(from);
  EXPECT_EQ(leaves("d"), -1);
}

TEST_F(PlacesTest, WhoSaysNothingLeavesBeforeWhoIsAnsweredAndThatBeforeAViewer) {
  for (const Standing standing : {Standing::kViews, Standing::kIsAnswered, Standing::kWaits, Standing::kViews}) {
    add(std::to_string(guests_.size()), standing);
  }
  for (const int expected : {2, 1, 0, 3}) {
    EXPECT_EQ(first_to_leave(all()), &guests_[static_cast<std::size_t>(expected)]);
    guests_[static_cast<std::size_t>(expected)].standing = Standing::kStays;
  }
  EXPECT_EQ(first_to_leave(all()), nullptr);
}

TEST_F(PlacesTest, StrangersLeaveBeforeWhoHasShownTheToken) {
  add("a", Standing::kWaits, true);
  add("b", Standing::kViews);
  EXPECT_EQ(first_to_leave(all()), &guests_[1]);
}

TEST_F(PlacesTest, OfEqualsWhoHasItLongestLeaves) {
  for (const char* from : {"a", "b", "c", "d"}) add(from);
  std::swap(guests_[0].since, guests_[2].since);
  EXPECT_EQ(first_to_leave(all()), &guests_[2]);
}

TEST_F(PlacesTest, WhoHasJustComeStaysForAllThatWereHeard) {
  for (int newcomers = 0; newcomers < 2; ++newcomers) {
    guests_.clear();
    add("a", Standing::kViews, true);
    add("a", Standing::kIsAnswered, true);
    add("a", Standing::kViews);
    add("a", Standing::kHasCome);
    if (newcomers == 1) add("a", Standing::kHasCome);
    for (const int expected : {2, 1, 0}) {
      EXPECT_EQ(first_to_leave(all()), &guests_[static_cast<std::size_t>(expected)]);
      guests_[static_cast<std::size_t>(expected)].standing = Standing::kStays;
    }
    EXPECT_EQ(first_to_leave(all()), &guests_[3]);
  }
}

TEST_F(PlacesTest, OfThoseWhoHaveJustComeTheFirstLeavesForAKnownOneWhereTheyAreMoreThanHalf) {
  add("a", Standing::kViews, true);
  for (int i = 0; i < 3; ++i) add("a", Standing::kHasCome);
  EXPECT_EQ(first_to_leave(all()), &guests_[1]);
  add("a", Standing::kIsAnswered);
  EXPECT_EQ(first_to_leave(all()), &guests_[4]) << "but strangers that were heard leave first";
}

TEST_F(PlacesTest, OfManyAddressesWithEquallyManyTheOneThatCameFirstLeaves) {
  for (const char* from : {"d", "b", "c", "a"}) add(from, Standing::kHasCome);
  EXPECT_EQ(leaves("e"), 0) << "none by its name";
}

TEST_F(PlacesTest, AnAddressThatHasAllThatOneMayHaveMakesRoomForItself) {
  for (int i = 0; i < 3; ++i) add("a");
  EXPECT_EQ(leaves("a"), 0) << "one place is free, and stays so for others";
  EXPECT_EQ(leaves("b"), -1);
}

TEST_F(PlacesTest, AFullPageMakesRoomAtTheAddressThatHasTheMost) {
  add("a");
  add("b", Standing::kViews);
  add("b", Standing::kViews);
  add("c");
  EXPECT_EQ(leaves("d"), 1) << "a crowd of viewers before the single guests";
  guests_[1].standing = guests_[2].standing = Standing::kStays;
  EXPECT_EQ(leaves("d"), 0) << "where nobody of the crowd may be sent away, another one";
}

TEST_F(PlacesTest, WhoGivesACommandOrDrivesLeavesForNobody) {
  for (const char* from : {"a", "b", "c", "d"}) add(from, Standing::kStays);
  EXPECT_EQ(leaves("e"), -2);
}

}  // namespace
}  // namespace deltamap::daemon::dashboard
