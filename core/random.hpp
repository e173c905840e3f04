// SPDX-License-Identifier: Apache-2.0
// The one source of chance: a small seeded generator that gives the same numbers on every machine and library.
#pragma once

#include <array>
#include <bit>
#include <cstdint>

namespace deltamap {

/// xoshiro128++ (Blackman and Vigna, "Scrambled linear pseudorandom number generators", 2021): 32-bit words, so that
/// it is fast on the netbook. Satisfies UniformRandomBitGenerator.
class Random {
 public:
  using result_type = std::uint32_t;

  explicit Random(std::uint64_t seed);

  result_type operator()() {
    const std::uint32_t result = std::rotl(state_[0] + state_[3], 7) + state_[0];
    const std::uint32_t t = state_[1] << 9;
    state_[2] ^= state_[0];
    state_[3] ^= state_[1];
    state_[1] ^= state_[2];
    state_[0] ^= state_[3];
    state_[2] ^= t;
    state_[3] = std::rotl(state_[3], 11);
    return result;
  }
  static constexpr result_type min() { return 0; }
  static constexpr result_type max() { return 0xFFFFFFFFu; }

  /// Uniform in [0, 1).
  [[nodiscard]] double uniform() { return (*this)() * 0x1p-32; }
  /// Uniform in [low, high).
  [[nodiscard]] double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// Uniform whole number in [0, count). count > 0.
  [[nodiscard]] std::uint32_t index_below(std::uint32_t count);
  /// Standard normal (mean 0, deviation 1), by the ratio of uniforms.
  [[nodiscard]] double normal();
  [[nodiscard]] double normal(double deviation) { return deviation * normal(); }

 private:
  std::array<std::uint32_t, 4> state_;
};

}  // namespace deltamap
