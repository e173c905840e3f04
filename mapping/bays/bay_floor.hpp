// SPDX-License-Identifier: Apache-2.0
// The floor of one bay in cells, and what the beams of the last looks say of each: beams went through it, ended in it,
// or it lies behind a face that stands. A body that passes leaves nothing behind: a cell changes its mind by several
// looks, and what has no straight face and is less than 1.6 m across is no load.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/messages.hpp"
#include "mapping/bays/bay.hpp"
#include "mapping/bays/line_of_cells.hpp"

namespace deltamap::mapping::bays {

/// Cells of the floor without its rim, which neighbours' walls and pose errors reach, as seen within the last seconds.
struct FloorCounts {
  int cells = 0;       ///< of that floor
  int free = 0;        ///< beams went through
  int free_since = 0;  ///< of them: also since a face has risen; all where none has
  int taken = 0;       ///< beams ended there, at a body
  int shadowed = 0;    ///< behind a body, and never seen free since it stands
  int small = 0;       ///< beams ended there, at what may be a person
  int risen = 0;       ///< of a straight face where the floor was free, apart from what stood, since the state was told
  bool body = false;   ///< one stands there, or on the rim

  [[nodiscard]] int known() const { return free + taken + shadowed; }
};

class BayFloor {
 public:
  explicit BayFloor(const Polygon& polygon);

  /// Beams of one scan that may meet the bay: [first, last) of its beams. `time_ds` never steps back.
  void look(const TrackedScan& tracked, std::size_t first, std::size_t last, std::uint32_t time_ds);
  /// What was seen within the last `window_ds`.
  [[nodiscard]] FloorCounts counts(std::uint32_t time_ds, std::uint32_t window_ds) const;
  /// At least `least_cells` of what counts() calls known have been seen then or later, tenths of a second.
  [[nodiscard]] std::uint32_t seen_since_ds(std::uint32_t time_ds, std::uint32_t window_ds, int least_cells) const;
  /// The last look that a body on the floor agreed with, or on the rim where the floor has none; 0 where none stands.
  [[nodiscard]] std::uint32_t body_seen_ds() const;
  /// Of what stands now a state is told: it has risen no more.
  void take_as_told();
  /// Nothing has been seen.
  void forget();

  /// Of a circle around the bay.
  [[nodiscard]] const Point2& middle() const { return middle_; }
  [[nodiscard]] double radius_m() const { return radius_m_; }

 private:
  struct FloorCell {
    std::uint32_t seen_ds = 0;   // last look that agreed with what the cell is
    std::uint32_t free_ds = 0;   // last look in which a beam went through
    std::uint32_t since_ds = 0;  // of its being an end of beams
    std::int8_t evidence = 0;    // negative: beams go through, positive: they end here
    std::uint8_t shadows = 0;    // looks in which it lay behind a body, since it was seen free
    std::uint8_t marks = 0;      // of this look
    std::uint8_t faces = 0;      // looks in which ends here lay on a straight face, less those in which they did not
    bool is_inside = false;
    bool is_core = false;  // not on the rim
    bool is_body = false;
    bool is_risen = false;     // as FloorCounts::risen, of any ends
    bool is_gathered = false;  // into a cluster, of the newest look
  };
  struct Cluster;

  /// The cell that it ends in.
  std::optional<std::size_t> mark_beam(const Point2& from, const Point2& end);
  struct BeamEnds;
  void mark_faces(BeamEnds& ends);
  void drop_lost_shadows();
  void take_end(std::size_t index, std::uint32_t time_ds);
  void take_marks(std::uint32_t time_ds);
  [[nodiscard]] bool is_beside_what_stood(std::size_t index) const;
  /// Of no cells where no beam ends there, or it belongs to another already.
  [[nodiscard]] Cluster cluster_from(int start);
  void find_bodies();
  [[nodiscard]] bool is_known(const FloorCell& cell, std::uint32_t time_ds, std::uint32_t window_ds) const;

  Pose2 bay_from_map_;
  CellLayout layout_;
  int core_cells_ = 0;
  Point2 middle_{0.0, 0.0};
  double radius_m_ = 0.0;
  std::vector<FloorCell> cells_;  // row by row, in the bay's frame
};

}  // namespace deltamap::mapping::bays
