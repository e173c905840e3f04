// SPDX-License-Identifier: Apache-2.0
#include "mapping/store/store_upgrade.hpp"

#include <gtest/gtest.h>

#include "mapping/store/guarded_rows.hpp"
#include "tests/mapping/store/written_store.hpp"

namespace deltamap::mapping::store {
namespace {

class StoreUpgrade : public StoreFile {};

TEST_F(StoreUpgrade, LeavesAStoreOfThisVersionAsItIs) {
  { const MapStore store{file, test::first_map()}; }
  Database database{file, Database::Mode::kExisting};
  bring_up_to_date(database);
  EXPECT_EQ(damaged_row(database), "");
}

}  // namespace
}  // namespace deltamap::mapping::store
