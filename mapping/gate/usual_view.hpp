// SPDX-License-Identifier: Apache-2.0
// What both detectors of the gate hold a scan against: how views usually are.
#pragma once

#include <cstdint>

namespace deltamap::mapping::gate {

inline constexpr double kUsualS = 10.0;              ///< over which what is usual is averaged
inline constexpr std::uint32_t kLeastCompared = 30;  ///< beams; a scan of which fewer can be compared says nothing

}  // namespace deltamap::mapping::gate
