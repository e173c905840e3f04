// SPDX-License-Identifier: Apache-2.0
#include "drivers/pioneer/baud_search.hpp"

#include <gtest/gtest.h>

namespace deltamap::drivers::pioneer {
namespace {

std::vector<unsigned> bauds(const std::vector<BaudProbe>& probes) {
  std::vector<unsigned> all;
  for (const BaudProbe& probe : probes) all.push_back(probe.baud);
  return all;
}

TEST(BaudSearch, LooksMostOftenWhereARobotWaitsAndWhereAConnectionWasLeft) {
  EXPECT_EQ(bauds(baud_search(9600, 38400, 38400)),
            (std::vector<unsigned>{9600, 38400, 115200, 9600, 38400, 19200, 9600, 38400, 57600, 9600}));
}

TEST(BaudSearch, LooksSoonWhereOursAreSwitchedTo) {
  const std::vector<unsigned> all = bauds(baud_search(19200, 19200, 38400));
  EXPECT_EQ((std::vector<unsigned>{all.begin(), all.begin() + 4}), (std::vector<unsigned>{19200, 38400, 19200, 9600}))
      << "a robot that seemed not to follow";
}

}  // namespace
}  // namespace deltamap::drivers::pioneer
