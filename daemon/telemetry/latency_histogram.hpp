// SPDX-License-Identifier: Apache-2.0
// How long things took, in constant memory: counts in steps of 1 %, from 1 µs to 100 s.
#pragma once

#include <array>
#include <cstdint>

namespace deltamap::daemon {

class LatencyHistogram {
 public:
  void add(double duration_s);

  [[nodiscard]] std::uint64_t count() const { return count_; }
  [[nodiscard]] double max_s() const { return max_s_; }
  /// The duration that a share of all stay at or below (at most 1 % too high); 0 where nothing was added.
  [[nodiscard]] double quantile_s(double share) const;

 private:
  std::array<std::uint32_t, 1860> bins_{};
  std::uint64_t count_ = 0;
  double max_s_ = 0.0;
};

}  // namespace deltamap::daemon
