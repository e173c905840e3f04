// SPDX-License-Identifier: Apache-2.0
// The journal of the map on disk (SQLite, write-ahead log): every Δ with its cells before and after, time, pose
// covariance, acceptance and cause, a whole grid every 64, and what was refused. Histories are told apart by the hash
// of M_0, so that another map never finds old revisions. Of the refusals the newest 1000 are kept. Used by one thread.
// What goes wrong is told by a StoreError: a store that opens is sound, byte for byte as far as it matters; what can be
// had of one that is not is store_recovery's business.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/grid/occupancy_grid.hpp"
#include "core/messages.hpp"
#include "mapping/store/retention.hpp"
#include "mapping/store/stored_revision.hpp"

namespace deltamap::mapping::store {

struct History;

class MapStore {
 public:
  /// Opens the history of M_0, and begins it where there is none. Throws StoreError: one line that names the file
  /// (foreign, damaged, not writable).
  MapStore(const std::filesystem::path& file, const OccupancyGrid& first);
  /// Opens the history that was used last in an existing file, to read or to roll back.
  explicit MapStore(const std::filesystem::path& file);
  /// Opens it for a moment's reading: one that this user may not write is read as it is, where no log lies beside it.
  /// Of one that is damaged, or is read as it is and of an older version, what can be had is read into memory.
  [[nodiscard]] static MapStore to_read(const std::filesystem::path& file);
  /// What can be had of the history of M_0, in memory, where the file cannot be opened: it is not touched.
  [[nodiscard]] static MapStore in_memory(const std::filesystem::path& file, const OccupancyGrid& first);
  ~MapStore();
  MapStore(MapStore&&) noexcept;
  MapStore& operator=(MapStore&&) noexcept;

  [[nodiscard]] std::uint32_t newest() const;
  /// What to_read() has found damaged, and what of it could be had; empty: nothing was.
  [[nodiscard]] const std::string& damage() const { return damage_; }
  /// Revisions that the file holds of other first maps, without those maps themselves.
  [[nodiscard]] std::uint32_t revisions_of_others() const;
  /// What another program has written since it was opened counts, too.
  void catch_up();
  /// M_k. Throws std::runtime_error where there is no such revision, or it is damaged.
  [[nodiscard]] OccupancyGrid grid(std::uint32_t number) const;
  /// Accepted and refused, in the order in which they were written.
  [[nodiscard]] std::vector<StoredRevision> history() const;

  /// The revision must follow the newest one.
  void append(const MapRevision& revision, const RevisionNote& note);
  /// M_k with everything that has changed since the newest revision, where those between were never written: they are
  /// missing from now on. The number is higher than the newest.
  void append_whole(std::uint32_t number, Timestamp time, const OccupancyGrid& map, const RevisionNote& note);
  void append_refusal(Timestamp time, const RevisionNote& note);
  /// Revisions that are provisional, oldest first, by the last note that tells of them; where the store holds several
  /// in one, that one.
  [[nodiscard]] std::vector<std::uint32_t> provisional() const;
  void set_provisional(const std::vector<std::uint32_t>& numbers);
  /// What led from M_{k-1} to M_k. Throws as grid() does; M_0 has no changes.
  [[nodiscard]] std::vector<CellChange> changes(std::uint32_t number) const;
  /// Writes M_k once more as the newest revision (nothing is lost), and returns its number.
  std::uint32_t roll_back(std::uint32_t number, Timestamp time);
  struct Undoing {
    std::vector<CellChange> changes;  ///< at least one
    std::size_t kept = 0;             ///< cells of the Δ that have changed since
    std::uint32_t held_before = 0;    ///< revisions before k that it holds, where retention has thinned them out
  };
  /// What takes Δ k back and leaves what came later as it is: its cells that no later revision has changed take the
  /// states they had before it. `newest_map` is that of the newest revision. Throws std::runtime_error where there is
  /// no such Δ, or nothing of it is left.
  [[nodiscard]] Undoing undoing(std::uint32_t number, const OccupancyGrid& newest_map) const;
  /// Writes undoing() as the newest revision and returns its number. Throws as that does.
  std::uint32_t undo(std::uint32_t number, Timestamp time);

  /// Turns the oldest steps that no rule keeps one by one into one step: at most 63, so that it takes a moment, and in
  /// one transaction. False where there is nothing to do. `now` is Unix time; what it means where the clock has jumped:
  /// store_retention.hpp.
  bool thin_out(const Retention& retention, Timestamp now);
  /// A named revision stays whatever the rules say; an empty name takes the name away. Throws as grid() does, and where
  /// the name is longer than 80 bytes or a line. Another program may write to the store meanwhile.
  void set_name(std::uint32_t number, const std::string& name);

 private:
  MapStore(std::unique_ptr<History> opened, const OccupancyGrid& first);
  /// With the history that was used last.
  explicit MapStore(std::unique_ptr<History> opened);
  std::unique_ptr<History> history_;
  std::string damage_;
};

}  // namespace deltamap::mapping::store
