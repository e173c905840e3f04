// SPDX-License-Identifier: Apache-2.0
// The surfaces of a map, found tile by tile where they are first asked for: a large map costs what has been in view.
#pragma once

#include <cstdint>
#include <memory>
#include <unordered_map>
#include <vector>

#include "core/grid/block_lattice.hpp"
#include "localization/sensor/scan_segments.hpp"
#include "localization/surfaces/surface.hpp"

namespace deltamap::localization::surfaces {

/// What is known of a surface of the map from earlier visits.
struct SurfaceRecord {
  Surface surface;
  double offset_m = 0.0;         ///< along the normal, from where the map has it, when it was last in view
  double visits_in_place = 0.0;  ///< in which it was where it had been before
  double visits = 0.0;
  /// P(holds) at the next visit.
  [[nodiscard]] double usually_holds() const {
    constexpr double kVisitsBefore = 3.0;  // that a surface is taken to have had
    return (kVisitsBefore * sensor::kUsuallyHolds + visits_in_place) / (kVisitsBefore + visits);
  }
  static constexpr std::int32_t kNotFollowed = -1;
  std::int32_t followed_as = kNotFollowed;  ///< its number among those that the filter follows
};

class SurfaceMap {
 public:
  /// Names a surface until the map changes there.
  struct Id {
    std::int32_t tile = -1;
    std::int32_t number = -1;
    [[nodiscard]] bool is_valid() const { return tile >= 0; }
    friend bool operator==(const Id&, const Id&) = default;
  };

  explicit SurfaceMap(std::shared_ptr<const OccupancyGrid> map);

  /// Takes another map that differs within the box alone: surfaces there are found anew; one that lies as before keeps
  /// what is known of it, and its name may change. False where the map's geometry is another one: then all is
  /// forgotten.
  [[nodiscard]] bool apply(std::shared_ptr<const OccupancyGrid> map, const CellBox& changed);

  /// Calls `use(Id, const SurfaceRecord&)` for every surface of the tiles within `reach_m` of a point.
  template <typename Use>
  void near(const Point2& at, double reach_m, Use&& use) {
    const CellBox tiles = tiles_around(at, reach_m);
    for (int row = tiles.first.row; row < tiles.last.row; ++row) {
      for (int column = tiles.first.column; column < tiles.last.column; ++column) {
        const auto tile = static_cast<std::int32_t>(lattice_.blocks().index_of({column, row}));
        const std::vector<SurfaceRecord>& records = records_of(tile);
        for (std::size_t i = 0; i < records.size(); ++i) use(Id{tile, static_cast<std::int32_t>(i)}, records[i]);
      }
    }
  }

  [[nodiscard]] SurfaceRecord& record(Id id) { return tiles_.at(id.tile)[static_cast<std::size_t>(id.number)]; }
  [[nodiscard]] const SurfaceRecord& record(Id id) const {
    return tiles_.at(id.tile)[static_cast<std::size_t>(id.number)];
  }
  /// The surface that lies where that one did; not valid where none is left.
  [[nodiscard]] Id like(const Surface& surface);

 private:
  [[nodiscard]] const std::vector<SurfaceRecord>& records_of(std::int32_t tile);
  [[nodiscard]] std::vector<SurfaceRecord> found_in(std::int32_t tile) const;
  [[nodiscard]] CellBox tiles_around(const Point2& at, double reach_m) const;

  std::shared_ptr<const OccupancyGrid> map_;
  BlockLattice lattice_;  // a block: a tile, at whose border longer surfaces are cut
  std::unordered_map<std::int32_t, std::vector<SurfaceRecord>> tiles_;
};

}  // namespace deltamap::localization::surfaces
