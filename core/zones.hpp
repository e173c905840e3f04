// SPDX-License-Identifier: Apache-2.0
// Areas of a site in which other rules hold, drawn by people. The polygon is that of a zone of VDA 5050; what it means
// for the map is this project's own.
#pragma once

#include <algorithm>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/geometry/polygon.hpp"

namespace deltamap {

enum class ZoneKind : std::uint8_t {
  kFrozen,     ///< Δ-mapping never writes a cell: walls that nobody may erase
  kTemporary,  ///< what differs there is transient, however long it stays: staging lanes
  kIgnore,     ///< the map there says nothing of the pose, nor do beams that end there
  kBlocked,    ///< the pilot never enters it
  kSpeedLimit  ///< the pilot drives no faster there
};

struct Zone {
  std::string id;
  std::string description{};  ///< for people; may be empty
  ZoneKind kind = ZoneKind::kFrozen;
  double most_speed_m_per_s = 0.0;  ///< of kSpeedLimit, > 0
  Polygon polygon;                  ///< simple, in the map

  friend bool operator==(const Zone&, const Zone&) = default;
};
using Zones = std::vector<Zone>;

/// Zones of one rule, looked at often.
class ZonedGround {
 public:
  ZonedGround() = default;
  ZonedGround(const Zones& zones, std::initializer_list<ZoneKind> kinds) {
    for (const Zone& zone : zones) {
      if (std::find(kinds.begin(), kinds.end(), zone.kind) == kinds.end()) continue;
      areas_.push_back({bounding_box(zone.polygon), zone.polygon});
    }
  }

  [[nodiscard]] bool empty() const { return areas_.empty(); }
  [[nodiscard]] bool covers(const Point2& in_map) const {
    return std::any_of(areas_.begin(), areas_.end(), [&](const Area& area) {
      return (in_map.array() >= area.box.low.array()).all() && (in_map.array() <= area.box.high.array()).all() &&
             contains(area.polygon, in_map);
    });
  }
  /// Boxes around all of them.
  [[nodiscard]] std::vector<PolygonBox> boxes() const {
    std::vector<PolygonBox> boxes;
    for (const Area& area : areas_) boxes.push_back(area.box);
    return boxes;
  }

 private:
  struct Area {
    PolygonBox box;
    Polygon polygon;
  };
  std::vector<Area> areas_;
};

}  // namespace deltamap
