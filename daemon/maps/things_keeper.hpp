// SPDX-License-Identifier: Apache-2.0
// The things of a running daemon: it begins with those that the store's revisions tell of, goes on with each revision,
// and writes each event into things.jsonl of --out and NAME.things.jsonl beside the store. The latter begins anew at a
// start, with all events of the store. Map thread.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "daemon/outputs/line_file.hpp"
#include "daemon/outputs/things_board.hpp"
#include "daemon/steps/map_step.hpp"
#include "daemon/telemetry/output_board.hpp"
#include "mapping/store/map_store.hpp"
#include "mapping/things/things.hpp"

namespace deltamap::daemon {

class ThingsKeeper {
 public:
  struct Options {
    const mapping::store::MapStore* store = nullptr;  ///< read once, at the start; null: nothing came before
    std::optional<std::filesystem::path> out{};       ///< an existing folder; nothing: no file there
    std::filesystem::path kept{};                     ///< beside the store; empty: no file there
    mapping::things::ThingsParams params{};
  };
  /// Begins both files anew. A store that cannot be read is warned of: then things count from here.
  ThingsKeeper(const Options& options, OutputBoard& board, const RetryingOutput::Warn& warn, Timestamp now);

  /// What a revision tells; nothing of a refusal.
  std::vector<mapping::things::ThingEvent> take(const MapStep::Result& result, Timestamp now);
  /// What a scan whose pose holds takes back of what was assumed.
  std::vector<mapping::things::ThingEvent> look(const TrackedScan& tracked, Timestamp now);
  [[nodiscard]] std::shared_ptr<const ThingList> list() const;
  /// What sets the thing's cells back to what they were before it. Throws std::runtime_error: one line that says why
  /// there is nothing to do.
  [[nodiscard]] std::vector<CellChange> undoing(std::uint32_t thing, const OccupancyGrid& map) const;
  /// Once a second.
  void retry(Timestamp now);
  void close(Timestamp now);

 private:
  void write(const std::vector<mapping::things::ThingEvent>& events, Timestamp now);

  mapping::things::Things things_;
  std::optional<LiveLines> out_;
  std::optional<LiveLines> kept_;
};

}  // namespace deltamap::daemon
