// SPDX-License-Identifier: Apache-2.0
// A chart of lines as HTML with SVG, for a page that needs nothing from elsewhere. The axes fit the data.
#pragma once

#include <string>

#include "reports/chart.hpp"

namespace deltamap::reports {

/// A <figure> of class "chart": caption, keys of the lines, and the lines; page/report.js tells the values under the
/// pointer.
[[nodiscard]] std::string figure_of(const Chart& chart);

/// From a round number below the data to one above; from 0 where the data begin near it.
struct Axis {
  double low = 0.0;
  double high = 1.0;
  double step = 0.5;  ///< between two ticks
};
[[nodiscard]] Axis axis_for(double low, double high);

/// Text with <, >, & and " made harmless.
[[nodiscard]] std::string escaped(const std::string& text);

}  // namespace deltamap::reports
