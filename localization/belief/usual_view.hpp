// SPDX-License-Identifier: Apache-2.0
// What the signs of a carried robot hold a scan against: how views usually are.
#pragma once

#include <cstdint>

namespace deltamap::localization::belief {

inline constexpr double kUsualS = 10.0;              ///< over which what is usual is averaged
inline constexpr std::uint32_t kLeastCompared = 30;  ///< beams; a scan of which fewer can be compared says nothing

}  // namespace deltamap::localization::belief
