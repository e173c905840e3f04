// SPDX-License-Identifier: Apache-2.0
// An operator changes the map (`deltamap ctl undo K`, `rollback K`). The order travels from the localization thread to
// the map thread among the scans and the sets, so that a replay comes to the same maps; the map thread looks up what it
// means, and the recording holds those cells: a replay sets them with any settings, and needs no store.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/messages.hpp"
#include "daemon/records/note_parts.hpp"
#include "daemon/site/site.hpp"
#include "mapping/bays/bays.hpp"

namespace deltamap::daemon {

struct MapOrder {
  enum class Kind : std::uint8_t {
    kUndo,      ///< Δ `revision` alone is taken back
    kRollBack,  ///< the map is M_`revision` again
    kUndoThing  ///< the cells of `thing` are what they were before it
  } kind = Kind::kUndo;
  std::uint32_t revision = 0;
  std::uint32_t thing = 0;
  std::uint32_t scan = 0;    ///< before which scan it was given
  Timestamp scan_time;       ///< Scan.time of that scan
  std::uint64_t ticket = 0;  ///< names the command in its CommandOutcome
};

/// What the delta thread reads, in order.
using DeltaWork = std::variant<TrackedScan, MapOrder, SharedSite>;
/// A scan that is held against what is assumed of things.
using ThingLook = std::shared_ptr<const TrackedScan>;
/// What the map thread reads, in order.
using MapWork = std::variant<MapRequest, MapOrder, mapping::bays::BayEvent, SharedSite, ThingLook>;

/// "undo of 7 by an operator", "rolled back to 3 …", "undo of thing 12 …": the reason of the revision that comes of it.
[[nodiscard]] std::string reason_of(const MapOrder& order);

/// The cells that an order has set.
struct SetCells {
  MapOrder order;
  int width = 0;   ///< of the map, cells
  int height = 0;  ///< of the map, cells
  std::vector<CellChange> changes;
};

/// For the recording: each note fits a pcapng comment.
[[nodiscard]] std::vector<std::string> notes_of(const SetCells& set);

/// Puts the notes of one order together again.
class SetCellsReader {
 public:
  SetCellsReader();
  /// Any note, in order; those of other kinds are passed over. An answer with the last note of an order; nothing where
  /// some are missing or damaged.
  [[nodiscard]] std::shared_ptr<const SetCells> read(std::string_view note);

 private:
  PartsReader parts_;
};

}  // namespace deltamap::daemon
