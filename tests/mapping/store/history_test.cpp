// SPDX-License-Identifier: Apache-2.0
#include "mapping/store/history.hpp"

#include <gtest/gtest.h>

#include "core/grid/occupancy_grid.hpp"

namespace deltamap::mapping::store {
namespace {

TEST(History, StoresNoMapWithoutASize) {
  EXPECT_FALSE(is_storable({0, 4, 0.05, {}}));
  EXPECT_TRUE(is_storable({4, 4, 0.05, {}}));
}

}  // namespace
}  // namespace deltamap::mapping::store
