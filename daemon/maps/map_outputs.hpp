// SPDX-License-Identifier: Apache-2.0
// Where the newest map goes besides the localizer: changes.jsonl, map.yaml and the history of --out, and store and
// map.newest of the settings. Each may pause and goes on by itself. Map thread.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "daemon/maps/revision_keeper.hpp"
#include "daemon/outputs/line_file.hpp"
#include "daemon/steps/map_step.hpp"
#include "daemon/telemetry/output_board.hpp"

namespace deltamap::daemon {

class MapOutputs {
 public:
  struct Options {
    std::optional<std::filesystem::path> out{};  ///< an existing folder; nothing: no files
    std::filesystem::path store_file{};          ///< of the settings; empty: none
    std::filesystem::path newest_file{};         ///< YAML of the newest map, of the settings; empty: none
    StoreToKeep store{};
    StartMap start;
    std::string_view method;
  };
  /// Begins the files of --out anew.
  MapOutputs(Options options, OutputBoard& board, const RetryingOutput::Warn& warn, Timestamp now);

  void save(const MapStep::Result& result, Timestamp now);
  /// Nothing is provisional any more.
  void settle(Timestamp now);
  /// As RevisionKeeper::cells_of(), from the store of the settings, else from the history of --out. Throws
  /// std::runtime_error where there is neither.
  [[nodiscard]] mapping::store::MapStore::Undoing cells_of(const MapOrder& order,
                                                           const OccupancyGrid& newest_map) const;
  /// Why what remembers the revisions does not hold the newest; empty where it does.
  [[nodiscard]] std::string why_behind() const;
  /// Once a second: what could not be written is tried again.
  void retry(Timestamp now);
  /// The last attempt.
  void close(Timestamp now);

 private:
  struct MapFile {
    std::filesystem::path yaml;
    RetryingOutput output;
    std::shared_ptr<const OccupancyGrid> waiting;  // null: what is on disk is the newest
    void write(const MapStep::Result& result, Timestamp now);
    void retry(Timestamp now);
    void close(Timestamp now);
  };

  [[nodiscard]] const RevisionKeeper* memory() const;

  std::optional<LiveLines> changes_;
  std::optional<MapFile> map_;             // of --out
  std::optional<MapFile> newest_;          // of the settings
  std::optional<RevisionKeeper> history_;  // of --out: begins with this run
  std::optional<RevisionKeeper> store_;    // of the settings
};

}  // namespace deltamap::daemon
