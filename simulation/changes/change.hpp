// SPDX-License-Identifier: Apache-2.0
// One act of the fork-lift, or one push of a container that creeps: what the map has to follow.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "simulation/world/world.hpp"

namespace deltamap::simulation {

enum class ChangeKind : std::uint8_t { kRemoved, kAdded, kShifted, kCrept };

struct Change {
  ChangeKind kind = ChangeKind::kRemoved;
  int id = 0;               ///< of the container
  Box box;                  ///< where it stands now; removed: where it stood
  std::optional<Box> from;  ///< shifted, crept: where it stood
};

[[nodiscard]] std::string_view name_of(ChangeKind kind);
[[nodiscard]] std::optional<ChangeKind> change_kind_named(std::string_view name);

/// The world after the change.
[[nodiscard]] World changed(const World& world, const Change& change);

}  // namespace deltamap::simulation
