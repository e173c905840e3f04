// SPDX-License-Identifier: Apache-2.0
#include "mapping/store/replaced_first_page.hpp"

#include <gtest/gtest.h>

#include "mapping/store/store_schema.hpp"
#include "tests/mapping/store/written_store.hpp"

namespace deltamap::mapping::store {
namespace {

class ReplacedFirstPageTest : public StoreFile {};

TEST_F(ReplacedFirstPageTest, IsACopyThatGoesWithIt) {
  { const MapStore store{file, test::first_map()}; }
  std::filesystem::path copy;
  {
    const ReplacedFirstPage replaced{file};
    copy = replaced.file();
    EXPECT_TRUE(std::filesystem::exists(copy));
  }
  EXPECT_FALSE(std::filesystem::exists(copy));
}

}  // namespace
}  // namespace deltamap::mapping::store
