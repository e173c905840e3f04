// SPDX-License-Identifier: Apache-2.0
// Is one of two settings better, or do the runs not tell? Both are run on the same recordings with the same seeds, and
// the differences of each pair are looked at: what makes a recording hard, or a seed lucky, falls out.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace deltamap {

struct PairedDifference {
  /// What the interval says something of.
  enum class Of : std::uint8_t {
    kNothing,     ///< too few pairs for an interval
    kSeeds,       ///< these recordings, with other seeds
    kRecordings,  ///< other recordings of the same kind
  } of = Of::kNothing;
  std::size_t pairs = 0;
  std::size_t recordings = 0;
  double mean = std::numeric_limits<double>::quiet_NaN();  ///< of the recordings' means, second less first
  double low = std::numeric_limits<double>::quiet_NaN();   ///< of the interval
  double high = std::numeric_limits<double>::quiet_NaN();

  [[nodiscard]] bool has_interval() const { return of != Of::kNothing; }
  /// The interval holds no zero.
  [[nodiscard]] bool is_shown() const { return has_interval() && (low > 0.0 || high < 0.0); }
};

/// `differences[recording][seed]`; NaN: no pair. From five recordings on each recording counts once and the interval
/// is that of their means (Student); with fewer it is that of the seeds within each recording (Welch and
/// Satterthwaite), which needs two of each. `confidence`: of the interval, between 0 and 1.
[[nodiscard]] PairedDifference paired_difference(const std::vector<std::vector<double>>& differences,
                                                 double confidence = 0.95);

/// The value that Student's t with so many degrees of freedom stays below with this probability.
/// 0 < probability < 1, freedom > 0.
[[nodiscard]] double student_quantile(double probability, double freedom);

}  // namespace deltamap
