// SPDX-License-Identifier: Apache-2.0
// One bay or zone that a person draws, changes or takes away on the page: asked for with the version of the list that
// he has seen, and checked as a file is.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "core/grid/grid_geometry.hpp"

namespace deltamap::daemon {

struct Site;

enum class PlaceKind : std::uint8_t { kBay, kZone };

struct SiteEdit {
  PlaceKind kind = PlaceKind::kZone;
  std::string version{};  ///< of the list that it was drawn on
  std::string of{};       ///< id of the place that is replaced or taken away; empty: the place is a new one
  std::string place{};    ///< one entry of the list in the keys of its file, as JSON; empty: `of` is taken away

  friend bool operator==(const SiteEdit&, const SiteEdit&) = default;
};

/// "bay", "zone"
[[nodiscard]] constexpr std::string_view name_of(PlaceKind kind) { return kind == PlaceKind::kBay ? "bay" : "zone"; }
/// The list of that kind as its file, whole.
[[nodiscard]] std::string file_text(const Site& site, PlaceKind kind);
/// Of that list: another one wherever anything in it is.
[[nodiscard]] std::string version_of(const Site& site, PlaceKind kind);
/// The site after it: exact to the millimetre, as its file is read again. `file` stands for the list in complaints.
/// Throws std::runtime_error: one line.
[[nodiscard]] Site edited(const Site& site, const SiteEdit& edit, const GridGeometry& map, const std::string& file);

}  // namespace deltamap::daemon
