// SPDX-License-Identifier: Apache-2.0
#include "mapping/merge/merge_refusal.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string_view>

namespace deltamap::mapping::merge {
namespace {

TEST(MergeRefusal, HasANameOfItsOwn) {
  std::set<std::string_view> names;
  constexpr int kRefusals = static_cast<int>(MergeRefusal::kAmbiguous) + 1;
  for (int i = 0; i < kRefusals; ++i) names.insert(name_of(static_cast<MergeRefusal>(i)));
  EXPECT_EQ(names.size(), static_cast<std::size_t>(kRefusals));
  EXPECT_EQ(names.count("?"), 0u);
}

}  // namespace
}  // namespace deltamap::mapping::merge
