// SPDX-License-Identifier: Apache-2.0
#include "mapping/store/chain_recovery.hpp"

#include <gtest/gtest.h>

namespace deltamap::mapping::store {
namespace {

TEST(ChainRecovery, OfNoStepsLosesNothing) { EXPECT_TRUE(remake_chain({}).empty()); }

}  // namespace
}  // namespace deltamap::mapping::store
