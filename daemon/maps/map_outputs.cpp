// SPDX-License-Identifier: Apache-2.0
#include "daemon/maps/map_outputs.hpp"

#include <stdexcept>
#include <system_error>
#include <utility>

#include "core/files/grid_file.hpp"
#include "mapping/store/database_log.hpp"

namespace deltamap::daemon {
namespace {

void remove_old(const std::filesystem::path& file) {
  std::error_code error;
  std::filesystem::remove(file, error);
  if (error) throw std::runtime_error(file.string() + ": cannot be removed: " + error.message());
}

/// A history of this run alone: when it is opened, now or later, the file of an earlier run is removed first.
StoreToKeep begun_history(const std::filesystem::path& file, const StartMap& start) {
  return {.to_lock = file,
          .open =
              [file, first = start.map] {
                const auto [log, index] = mapping::store::log_of(file);
                for (const auto& old : {file, log, index}) remove_old(old);
                return mapping::store::MapStore{file, *first};
              },
          .numbers_before = start.revision};
}

}  // namespace

MapOutputs::MapOutputs(Options options, OutputBoard& board, const RetryingOutput::Warn& warn, Timestamp now) {
  if (options.out) {
    const auto changes = *options.out / "changes.jsonl";
    changes_.emplace(changes, RetryingOutput{"changes", changes, board, warn});
    changes_->flush(now);
    const auto map = *options.out / "map.yaml";
    map_.emplace(MapFile{map, {"map", map, board, warn}, options.start.map});
    map_->retry(now);
    const auto history = *options.out / "map_store.sqlite";
    std::error_code ignored;
    // The store of the settings already holds the history where it is the same file.
    if (options.store_file.empty() || !std::filesystem::equivalent(history, options.store_file, ignored)) {
      history_.emplace(begun_history(history, options.start), options.method,
                       RetryingOutput{"history", history, board, warn}, now);
    }
  }
  if (!options.newest_file.empty()) {
    newest_.emplace(MapFile{options.newest_file, {"newest", options.newest_file, board, warn}, options.start.map});
    newest_->retry(now);
  }
  if (options.store_file.empty()) return;
  store_.emplace(std::move(options.store), options.method, RetryingOutput{"store", options.store_file, board, warn},
                 now);
}

void MapOutputs::save(const MapStep::Result& result, Timestamp now) {
  if (changes_) {
    changes_->write(json_line(result.note), now);
    changes_->flush(now);
  }
  if (history_) history_->take(result, now);
  if (map_) map_->write(result, now);
  if (store_) store_->take(result, now);
  if (newest_) newest_->write(result, now);
}

void MapOutputs::settle(Timestamp now) {
  if (history_) history_->settle(now);
  if (store_) store_->settle(now);
}

const RevisionKeeper* MapOutputs::memory() const { return store_ ? &*store_ : history_ ? &*history_ : nullptr; }

mapping::store::MapStore::Undoing MapOutputs::cells_of(const MapOrder& order, const OccupancyGrid& newest_map) const {
  if (memory() == nullptr) throw std::runtime_error("'map.store' is not set: nothing remembers the revisions");
  return memory()->cells_of(order, newest_map);
}

std::string MapOutputs::why_behind() const { return memory() == nullptr ? std::string{} : memory()->why_behind(); }

void MapOutputs::retry(Timestamp now) {
  if (changes_) changes_->flush(now);
  if (map_) map_->retry(now);
  if (newest_) newest_->retry(now);
  if (history_) history_->retry(now);
  if (store_) store_->retry(now);
}

void MapOutputs::close(Timestamp now) {
  if (changes_) changes_->close(now);
  if (map_) map_->close(now);
  if (newest_) newest_->close(now);
  if (history_) history_->close(now);
  if (store_) store_->close(now);
}

void MapOutputs::MapFile::write(const MapStep::Result& result, Timestamp now) {
  if (!result.revision) return;
  waiting = result.revision->map;
  retry(now);
}

void MapOutputs::MapFile::close(Timestamp now) {
  output.hurry();
  retry(now);
}

void MapOutputs::MapFile::retry(Timestamp now) {
  if (waiting == nullptr) return;
  if (output.attempt(now, [this] { write_grid(*waiting, yaml); })) waiting.reset();
}

}  // namespace deltamap::daemon
