// SPDX-License-Identifier: Apache-2.0
#include "mapping/store/row_sum.hpp"

#include <gtest/gtest.h>

#include "mapping/store/database.hpp"

namespace deltamap::mapping::store {
namespace {

TEST(RowSum, TellsValuesAndTheirTypesApart) {
  Database database{"sums", Database::Mode::kMemory};
  EXPECT_EQ(database.number("SELECT row_sum(1, 2) = row_sum(1, 2)"), 1);
  EXPECT_EQ(database.number("SELECT row_sum(1, 2) = row_sum(2, 1)"), 0);
  EXPECT_EQ(database.number("SELECT row_sum(1) = row_sum(1.0)"), 0);
}

}  // namespace
}  // namespace deltamap::mapping::store
