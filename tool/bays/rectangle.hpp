// SPDX-License-Identifier: Apache-2.0
// What both kinds of imports share: numbers as text, and a place that is given by its middle.
#pragma once

#include <optional>
#include <string>

#include "tool/bays/bay_import.hpp"

namespace deltamap::tool {

/// The whole text is one finite number.
[[nodiscard]] std::optional<double> finite_number(const std::string& text);

[[nodiscard]] Polygon rectangle_of(const Pose2& map_from_bay, const BaySize& size);

}  // namespace deltamap::tool
