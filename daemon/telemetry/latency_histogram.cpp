// SPDX-License-Identifier: Apache-2.0
#include "daemon/telemetry/latency_histogram.hpp"

#include <algorithm>
#include <cmath>

namespace deltamap::daemon {
namespace {

constexpr double kShortest_s = 1e-6;
constexpr double kStep = 0.01;  // of the logarithm: e^0.01 is 1 %

}  // namespace

void LatencyHistogram::add(double duration_s) {
  const double steps = std::log(std::max(duration_s, kShortest_s) / kShortest_s) / kStep;
  const auto bin = std::min(static_cast<std::size_t>(steps), bins_.size() - 1);
  ++bins_[bin];
  ++count_;
  max_s_ = std::max(max_s_, duration_s);
}

double LatencyHistogram::quantile_s(double share) const {
  const auto wanted = static_cast<std::uint64_t>(std::ceil(share * static_cast<double>(count_)));
  std::uint64_t below = 0;
  for (std::size_t bin = 0; bin < bins_.size() && count_ > 0; ++bin) {
    below += bins_[bin];
    if (below >= wanted) return std::min(max_s_, kShortest_s * std::exp(kStep * static_cast<double>(bin + 1)));
  }
  return max_s_;
}

}  // namespace deltamap::daemon
