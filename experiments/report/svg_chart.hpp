// SPDX-License-Identifier: Apache-2.0
// A chart of lines as SVG text, for a page that needs nothing from elsewhere.
#pragma once

#include <string>

#include "experiments/experiment.hpp"

namespace deltamap::experiments {

[[nodiscard]] std::string svg_of(const Chart& chart);

/// Text with <, >, & and " made harmless.
[[nodiscard]] std::string escaped(const std::string& text);

}  // namespace deltamap::experiments
