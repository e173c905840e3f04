// SPDX-License-Identifier: Apache-2.0
// The chance of each thing in a simulation, all from one seed: a change to one does not touch what befalls the others.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/random.hpp"

namespace deltamap::simulation {

/// `Stream` is an enumeration of fewer than 64; `index` tells things of the same kind apart.
template <typename Stream>
[[nodiscard]] Random random_for(std::uint64_t seed, Stream stream, std::size_t index = 0) {
  constexpr std::uint64_t kSpread = 0x9E3779B97F4A7C15u;
  return Random{seed * kSpread + 64 * (index + 1) + static_cast<std::uint64_t>(stream)};
}

}  // namespace deltamap::simulation
