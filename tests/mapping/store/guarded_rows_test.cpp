// SPDX-License-Identifier: Apache-2.0
#include "mapping/store/guarded_rows.hpp"

#include <gtest/gtest.h>

#include "mapping/store/store_schema.hpp"
#include "tests/mapping/store/written_store.hpp"

namespace deltamap::mapping::store {
namespace {

class GuardedRows : public StoreFile {};

TEST_F(GuardedRows, NameARowThatIsNotWhatWasWritten) {
  {
    MapStore store{file, test::first_map()};
    fill(store, 3);
  }
  run_sql(file, "UPDATE revision SET phase = 77 WHERE number = 2");
  Database database{file, Database::Mode::kExisting};
  EXPECT_EQ(damaged_row(database), "revision 2 is not what was written");
}

}  // namespace
}  // namespace deltamap::mapping::store
