// SPDX-License-Identifier: Apache-2.0
#include "core/random.hpp"

#include <cassert>
#include <cmath>

namespace deltamap {
namespace {

// splitmix64: spreads any seed, even 0, over the whole state.
std::uint64_t splitmix64(std::uint64_t& state) {
  state += 0x9E3779B97F4A7C15u;
  std::uint64_t z = state;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
  return z ^ (z >> 31);
}

}  // namespace

Random::Random(std::uint64_t seed) : state_{} {
  for (std::size_t i = 0; i < state_.size(); i += 2) {
    const std::uint64_t word = splitmix64(seed);
    state_[i] = static_cast<std::uint32_t>(word);
    state_[i + 1] = static_cast<std::uint32_t>(word >> 32);
  }
}

std::uint32_t Random::index_below(std::uint32_t count) {
  assert(count > 0 && "there must be something to choose from");
  return static_cast<std::uint32_t>((static_cast<std::uint64_t>((*this)()) * count) >> 32);
}

double Random::normal() {
  // Kinderman and Monahan 1977: 1.37 pairs of uniforms a number. The bounds around the exact test, which spare nearly
  // every logarithm, are those of Leva, "A fast normal random number generator", 1992.
  constexpr double kWidth = 1.7155277699214135;  // 2 sqrt(2 / e)
  for (;;) {
    const double u = ((*this)() + 0.5) * 0x1p-32;
    const double v = kWidth * (uniform() - 0.5);
    const double x = u - 0.449871;
    const double y = std::abs(v) + 0.386595;
    const double q = x * x + y * (0.19600 * y - 0.25472 * x);
    if (q > 0.27846) continue;
    if (q < 0.27597 || v * v <= -4.0 * u * u * std::log(u)) return v / u;
  }
}

}  // namespace deltamap
