// SPDX-License-Identifier: Apache-2.0
#include "mapping/store/readable_rows.hpp"

#include <gtest/gtest.h>

#include "mapping/store/store_schema.hpp"
#include "tests/mapping/store/written_store.hpp"

namespace deltamap::mapping::store {
namespace {

class ReadableRowsTest : public StoreFile {};

TEST_F(ReadableRowsTest, AreEveryRevisionOfASoundStore) {
  {
    MapStore store{file, test::first_map()};
    fill(store, 3);
  }
  const ReadableRows rows{file};
  ASSERT_EQ(rows.maps().size(), 1u);
  EXPECT_EQ(rows.maps().begin()->second.revisions.size(), 4u);
}

}  // namespace
}  // namespace deltamap::mapping::store
