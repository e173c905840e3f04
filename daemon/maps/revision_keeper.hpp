// SPDX-License-Identifier: Apache-2.0
// Puts what became of each Δ-phase into a map store: accepted revisions and refusals. Where the store cannot be
// written, the newest map waits, and is stored whole as one revision when it can again: the store then holds M_k, and
// misses only the steps that led to it. Map thread.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "core/files/file_lock.hpp"
#include "daemon/outputs/retrying_output.hpp"
#include "daemon/steps/map_step.hpp"
#include "mapping/store/map_store.hpp"

namespace deltamap::daemon {

/// `numbers_before` is what the store does not count: the revision that the run started on, where the store began with
/// it; modulo 2^32, for a store can be ahead of the run. Throws std::runtime_error naming the file.
void keep(mapping::store::MapStore& store, const MapStep::Result& result, std::string_view method,
          std::uint32_t numbers_before = 0);

/// A store that takes a run's revisions, and how to open it where that was not possible yet.
struct StoreToKeep {
  std::filesystem::path to_lock{};  ///< the file that this run alone may write to; empty: locked elsewhere
  std::optional<FileLock> lock{};   ///< nothing: there could be none yet; until the end of the run
  std::optional<mapping::store::MapStore> store{};
  std::function<mapping::store::MapStore()> open{};
  std::string why_not{};             ///< where it is not open
  std::uint32_t numbers_before = 0;  ///< as keep() has it
  mapping::store::Retention retention{};
};

class RevisionKeeper {
 public:
  /// `method` as MapStep has it.
  RevisionKeeper(StoreToKeep store, std::string_view method, RetryingOutput output, Timestamp now);

  void take(const MapStep::Result& result, Timestamp now);
  /// Nothing is provisional any more.
  void settle(Timestamp now);
  /// What an order would set in the newest map of the run; `kept` as MapStore has it, 0 for a rollback. Throws
  /// std::runtime_error with one line: the store is behind, it has no such revision, or there is nothing to do.
  [[nodiscard]] mapping::store::MapStore::Undoing cells_of(const MapOrder& order,
                                                           const OccupancyGrid& newest_map) const;
  /// Why the store does not hold the newest revision; empty where it does.
  [[nodiscard]] std::string why_behind() const;
  /// Once a second, while nothing else is to be done: what could not be stored is tried again, and a little of what the
  /// retention does not keep goes.
  void retry(Timestamp now);
  /// The last attempt.
  void close(Timestamp now);

 private:
  /// Throws FileInUse where another program has the store by now.
  void lock();
  /// Of a revision of the run. Throws std::runtime_error where it is older than the store.
  [[nodiscard]] std::uint32_t number_in_store(std::uint32_t revision) const;
  /// The store's newest revision is the one before this.
  [[nodiscard]] bool follows(const MapRevision& revision) const;
  struct Missed {
    std::uint32_t first = 0;  ///< number of the oldest that was missed
    MapStep::Result newest;   ///< its changes are left out
  };
  void miss(const MapStep::Result& result);
  /// Throws std::runtime_error naming the file.
  void store_missed();
  void store_whole(const Missed& missed);
  void store_waiting(Timestamp now);
  void thin_out(Timestamp now);

  StoreToKeep to_;
  std::string method_;
  RetryingOutput output_;
  std::optional<Missed> missed_revision_;
  std::optional<MapStep::Result> missed_refusal_;  // the newest
  bool missed_settlement_ = false;                 // since what was missed
  std::optional<Timestamp> looked_for_old_;        // when nothing was found that could go
};

}  // namespace deltamap::daemon
