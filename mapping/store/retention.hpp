// SPDX-License-Identifier: Apache-2.0
// How many revisions a map store keeps one by one. A revision stays where one of the rules keeps it; without a rule all
// stay. Whole maps (the first, every 64th, named ones) and the newest revision stay in any case.
#pragma once

#include <cstdint>

namespace deltamap::mapping::store {

struct Retention {
  std::uint32_t revisions = 0;  ///< the newest so many stay; 0: no such rule
  double days = 0.0;            ///< those that are younger stay; 0: no such rule

  [[nodiscard]] bool keeps_all() const { return revisions == 0 && days <= 0.0; }
};

}  // namespace deltamap::mapping::store
