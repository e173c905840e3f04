// SPDX-License-Identifier: Apache-2.0
// What the map thread does with each S(k), and what a replay does in its place: updates the newest map, prepares the
// localizer's patch, and says what became of the Δ-phase. What it writes is provisional until a later set, or word of
// its own, says that it is settled; an order takes it back, in a later run as well. An operator sets cells as he wants
// them. The revision goes to the localizer, the note to changes.jsonl.
#pragma once

#include <deque>
#include <optional>
#include <string_view>
#include <vector>

#include "core/messages.hpp"
#include "daemon/outputs/outputs.hpp"
#include "daemon/records/map_order.hpp"
#include "daemon/settings/settings.hpp"
#include "daemon/steps/localization_step.hpp"
#include "mapping/gate/operator_cells.hpp"
#include "mapping/scan_set/map_change.hpp"

namespace deltamap::daemon {

class MapStep {
 public:
  MapStep(const Settings& settings, StartMap start);

  struct Result {
    std::optional<MapRevision> revision;
    ChangeNote note;
    mapping::scan_set::Refusal refusal = mapping::scan_set::Refusal::kNone;  ///< of a set
    std::vector<std::uint32_t> provisional{};  ///< numbers of what is so from then on, oldest first
  };
  /// A set becomes a revision or is refused; an order takes back, in one revision, what was written since then and is
  /// not settled. Nothing where something is settled and no more.
  [[nodiscard]] std::optional<Result> take(const MapRequest& request);
  /// An operator's cells take the states that the order gives them, whatever they are. Older evidence does not write
  /// them again. No revision where they are so already, or the map has another size.
  [[nodiscard]] Result obey(const SetCells& wanted);

  /// From the next set on: within frozen and temporary zones no set writes a cell. Orders of an operator do, and what a
  /// wrong pose has written before is taken back.
  void set_zones(const Zones& zones) { unwritten_ = ZonedGround{zones, {ZoneKind::kFrozen, ZoneKind::kTemporary}}; }

  /// "paper" or "evidence": kept with each revision.
  [[nodiscard]] std::string_view method() const { return method_; }
  /// M_k, the newest map.
  [[nodiscard]] const std::shared_ptr<const OccupancyGrid>& map() const { return newest_.map; }
  [[nodiscard]] std::uint32_t revision() const { return newest_.revision; }
  /// For a run that goes on from here.
  [[nodiscard]] std::vector<ProvisionalRevision> provisional() const;
  [[nodiscard]] std::vector<std::uint32_t> provisional_numbers() const;

 private:
  struct Provisional {
    ProvisionalRevision revision;
    Timestamp time;  // before all others where an earlier run has written it
  };

  [[nodiscard]] Result update(const ScanSet& set);
  /// Without what zones and operators forbid.
  [[nodiscard]] mapping::scan_set::MapUpdate allowed(mapping::scan_set::MapUpdate update, const ScanSet& set) const;
  [[nodiscard]] Result withdraw(const WithdrawOrder& order);
  void settle(const std::optional<Timestamp>& before);
  [[nodiscard]] MapRevision publish(Timestamp time, std::vector<CellChange> changes);

  std::string_view method_;
  mapping::MapUpdateParams update_;
  localization::LocalizerParams localizer_;
  StartMap newest_;
  std::deque<Provisional> provisional_;  // oldest first
  ZonedGround unwritten_;
  mapping::gate::OperatorCells operator_cells_;  // that an operator has set
};

}  // namespace deltamap::daemon
