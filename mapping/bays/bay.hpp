// SPDX-License-Identifier: Apache-2.0
// A place on the floor that goods are put on, and what is known of it. All places in the map frame.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "core/geometry/polygon.hpp"
#include "core/time.hpp"

namespace deltamap::mapping::bays {

struct Bay {
  std::string id;
  std::string name{};        ///< for people; may be empty
  std::string station_id{};  ///< of the station in a LIF file; may be empty
  Polygon polygon;           ///< simple

  friend bool operator==(const Bay&, const Bay&) = default;
};

enum class BayState : std::uint8_t {
  kUnknown,  ///< nobody has seen enough of it, or what was seen contradicts what was known
  kEmpty,
  kPartly,
  kFull
};

[[nodiscard]] std::string_view name_of(BayState state);

/// What is known of a bay, and of when.
struct BayStatus {
  BayState state = BayState::kUnknown;
  double share = 0.0;                ///< of its floor that is taken, [0, 1]; 0 where unknown
  double confidence = 0.0;           ///< share of its floor that this rests on, [0, 1]
  std::optional<Timestamp> seen{};   ///< most of the floor was looked at then or later, and was so; nothing: never
  std::optional<Timestamp> since{};  ///< of the first scan that showed this state; nothing: unknown from the start

  friend bool operator==(const BayStatus&, const BayStatus&) = default;
};

}  // namespace deltamap::mapping::bays
