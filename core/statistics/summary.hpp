// SPDX-License-Identifier: Apache-2.0
// Numbers that sum up many. NaN where there are no values.
#pragma once

#include <vector>

namespace deltamap {

[[nodiscard]] double mean_of(const std::vector<double>& values);
[[nodiscard]] double root_mean_square(const std::vector<double>& values);
/// The smallest value that at least this share of all does not exceed.
[[nodiscard]] double quantile(std::vector<double> values, double share);
/// Share of the values above a limit.
[[nodiscard]] double share_above(const std::vector<double>& values, double limit);

/// The most that the true share may be where `hits` of `all` were seen: upper end of Wilson's interval of 95 %.
[[nodiscard]] double wilson_upper(double hits, double all);

}  // namespace deltamap
