// SPDX-License-Identifier: Apache-2.0
#include "mapping/merge/spectrum_peak.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace deltamap::mapping::merge {
namespace {

TEST(BestPeaks, AreApartAndBestFirst) {
  const std::vector<double> signal{0.0, 3.0, 2.0, 0.0, 5.0, 5.0, 0.0, 1.0, 0.0};
  const auto peaks = best_peaks(signal, 5, 1, SpectrumEnds::kOpen);
  ASSERT_EQ(peaks.size(), 3U);
  EXPECT_EQ(peaks[0].index, 4U);
  EXPECT_EQ(peaks[1].index, 1U);
  EXPECT_EQ(peaks[2].index, 7U);
  EXPECT_EQ(best_peaks(signal, 5, 3, SpectrumEnds::kOpen).size(), 1U);
  EXPECT_EQ(best_peaks(std::vector<double>{4.0, 1.0, 0.0, 5.0}, 5, 1, SpectrumEnds::kJoined).size(), 1U);
}

}  // namespace
}  // namespace deltamap::mapping::merge
