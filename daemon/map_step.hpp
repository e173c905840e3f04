// SPDX-License-Identifier: Apache-2.0
// What the map thread does with each S(k), and what a replay does in its place: updates the newest map, prepares the
// localizer's patch, and says what became of the Δ-phase. The revision goes to the localizer, the note to
// changes.jsonl.
#pragma once

#include <optional>
#include <string_view>

#include "core/messages.hpp"
#include "daemon/localization_step.hpp"
#include "daemon/outputs.hpp"
#include "daemon/settings.hpp"

namespace deltamap::daemon {

class MapStep {
 public:
  MapStep(const Settings& settings, StartMap start);

  struct Result {
    std::optional<MapRevision> revision;
    ChangeNote note;
  };
  [[nodiscard]] Result update(const ScanSet& set);

  /// "paper" or "evidence": kept with each revision.
  [[nodiscard]] std::string_view method() const { return method_; }
  /// M_k, the newest map.
  [[nodiscard]] const std::shared_ptr<const OccupancyGrid>& map() const { return newest_.map; }
  [[nodiscard]] std::uint32_t revision() const { return newest_.revision; }

 private:
  std::string_view method_;
  mapping::MapUpdateParams update_;
  localization::LocalizerParams localizer_;
  StartMap newest_;
};

}  // namespace deltamap::daemon
