// SPDX-License-Identifier: Apache-2.0
// When and how particles are drawn anew: the effective sample size (paper Eq. 5), low-variance resampling (Thrun,
// Burgard and Fox, "Probabilistic Robotics", 2005, Table 4.4) and the number that suffices (Fox, "KLD-Sampling", 2001,
// Eq. 7).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace deltamap::localization::particles {

/// N_eff = (Σ w)² / Σ w² (Eq. 5, for weights that need not be normalized); 0 for no or only zero weights.
[[nodiscard]] double effective_sample_size(std::span<const double> weights);

/// Which particle each of `count` new ones comes from, in rising order: a comb with one random offset in [0, 1).
/// The weights sum to 1. The answer lives in `choice` (its memory is reused).
[[nodiscard]] std::vector<std::uint32_t> low_variance_choice(std::span<const double> weights, std::size_t count,
                                                             double offset, std::vector<std::uint32_t> choice = {});

/// How many particles bound the error to `error` with the quantile `z` (of the normal distribution) when they fill
/// `bins` cells.
[[nodiscard]] std::size_t kld_sample_count(std::size_t bins, double error, double z);

}  // namespace deltamap::localization::particles
