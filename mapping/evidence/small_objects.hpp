// SPDX-License-Identifier: Apache-2.0
// Small objects of the map that are gone. One beam through a small object says little: at another pose within the
// uncertainty it would have passed beside. A fan of beams says more: at every such pose one of them would have met it.
// What was small in the run's first map is left alone: a table's leg or a pole, which beams miss more often than not.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/grid/grid_patch.hpp"
#include "core/grid/tiled.hpp"
#include "mapping/votes/beam_evidence.hpp"
#include "mapping/votes/pose_deviation.hpp"

namespace deltamap::mapping::evidence {

struct SmallObjectParams {
  double most_side_m = 0.8;  ///< of the box around a group of occupied cells; larger ones are surfaces; > 0
  double most_step = 0.8;    ///< between neighbouring beams at the object, of its width; (0, 1)
  int thin_looks = 8;        ///< scans in which one beam goes through its middle that count as one denser fan; >= 1
};

class SmallObjects {
 public:
  SmallObjects() = default;
  explicit SmallObjects(const SmallObjectParams& params) : params_{params} {}

  /// What is small in this map is no small object, here and in all maps that follow.
  void begin(const OccupancyGrid& map);
  /// Finds the small groups of occupied cells around the changes that have led to this map.
  void follow(const OccupancyGrid& map, std::span<const CellChange> changes);

  [[nodiscard]] bool is_of_small_object(Cell cell) const { return (flags_[cell] & kOfSmallObject) != 0; }

  /// All cells of the small objects that any of these cells belongs to.
  [[nodiscard]] std::vector<Cell> whole(std::span<const Cell> some) const;

  /// The cells of all small objects that the beams of a scan would have met, and have not: every beam that may have
  /// passed there ends clearly beyond. From farther away, where the fan has gaps, it takes several scans in which the
  /// best pose sends a beam right through. `beams`: the verdicts on `tracked`.
  [[nodiscard]] std::vector<Cell> missed(const TrackedScan& tracked, std::span<const votes::BeamVerdict> beams,
                                         const votes::BeamEvidenceParams& params);

 private:
  using Flags = std::uint8_t;  // any of the following
  static constexpr Flags kThin = 1, kOfSmallObject = 2;
  static constexpr Flags kTaken = 4, kWide = 8, kTouched = 16;  // only while groups are looked for
  struct SmallObject {
    Point2 middle{0.0, 0.0};
    double radius_m = 0.0;  ///< of the circle around all its cells
    std::vector<Cell> cells;
    int thin_looks = 0;  ///< since it was missed or met last
  };
  enum class Look : std::uint8_t { kNothing, kMet, kThrough, kMissed };
  [[nodiscard]] Flags& flags_of(Cell cell) { return flags_.to_write(cell); }
  struct Group {
    std::vector<Cell> cells;
    CellBox box;  ///< around them
  };
  /// All that is joined to an occupied cell; nothing where it is too wide.
  [[nodiscard]] std::optional<Group> small_group(const OccupancyGrid& map, Cell start);
  void gather(const OccupancyGrid& map, std::span<const Cell> starts);
  [[nodiscard]] Look look_at(const SmallObject& object, const TrackedScan& tracked,
                             std::span<const votes::BeamVerdict> beams, const PoseDeviation& deviation,
                             const votes::BeamEvidenceParams& params) const;
  [[nodiscard]] bool is_missed(SmallObject& object, Look look) const;

  SmallObjectParams params_;
  GridGeometry geometry_;
  std::vector<SmallObject> small_objects_;
  Tiled<Flags> flags_;       // of each cell
  std::vector<Cell> taken_;  // whose flags of looking are set
};

}  // namespace deltamap::mapping::evidence
