// SPDX-License-Identifier: Apache-2.0
// The colours of the pictures, after Okabe and Ito: told apart by colour-blind people, too.
#pragma once

#include <array>
#include <cstdint>

namespace deltamap::tool::picture {

using Ink = std::array<std::uint8_t, 3>;  ///< red, green, blue

inline constexpr Ink kFree{255, 255, 255};
inline constexpr Ink kOccupied{24, 26, 30};
inline constexpr Ink kUnknown{204, 208, 213};
inline constexpr Ink kNewlyOccupied{213, 94, 0};
inline constexpr Ink kNewlyFree{86, 180, 233};
inline constexpr Ink kForgotten{204, 121, 167};
inline constexpr Ink kRobot{0, 60, 130};
inline constexpr Ink kPath{0, 114, 178};
inline constexpr Ink kScan{0, 158, 115};
inline constexpr Ink kRing{110, 0, 0};
inline constexpr Ink kText{24, 26, 30};
inline constexpr Ink kPaper{255, 255, 255};

}  // namespace deltamap::tool::picture
