// SPDX-License-Identifier: Apache-2.0
#include "core/ziggurat.hpp"

#include <cmath>

namespace deltamap {
namespace {

// Of 128 layers of equal area under exp(-x²/2) (Marsaglia and Tsang, table 1).
constexpr double kTailBegins = 3.442619855899;
constexpr double kArea = 9.91256303526217e-3;

double density(double x) { return std::exp(-0.5 * x * x); }

}  // namespace

Ziggurat::Ziggurat() {
  width_[0] = kArea / density(kTailBegins);  // as wide as it must be to hold the tail's area too
  width_[1] = kTailBegins;
  for (std::size_t i = 2; i < kLayers; ++i) {
    width_[i] = std::sqrt(-2.0 * std::log(kArea / width_[i - 1] + density(width_[i - 1])));
  }
  for (std::size_t i = 0; i < kLayers; ++i) inner_share_[i] = width_[i + 1] / width_[i];
}

/// Marsaglia, "Generating a variable from the tail of the normal distribution", 1964.
double Ziggurat::beyond_the_layers(Random& random, bool negative) {
  for (;;) {
    const double x = -std::log(1.0 - random.uniform()) / kTailBegins;
    const double y = -std::log(1.0 - random.uniform());
    if (2.0 * y >= x * x) return negative ? -(kTailBegins + x) : kTailBegins + x;
  }
}

bool Ziggurat::is_below_the_curve(Random& random, std::size_t layer, double value) const {
  const double low = density(width_[layer]);
  const double high = density(width_[layer + 1]);
  return low + random.uniform() * (high - low) < density(value);
}

}  // namespace deltamap
