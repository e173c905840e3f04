// SPDX-License-Identifier: Apache-2.0
// Parts of a map that the scans hold together: two passes that see the same walls at the same places belong to one
// piece. How pieces lie to each other, nothing tells but the wheels.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "surveying/quality/pass_pairs.hpp"

namespace deltamap::surveying::quality {

struct Piece {
  std::vector<std::uint32_t> passes;
  double way_m = 0.0;
};
/// The longest first.
[[nodiscard]] std::vector<Piece> pieces_of(std::span<const Pass> passes, std::span<const PassPair> pairs);

}  // namespace deltamap::surveying::quality
