// SPDX-License-Identifier: Apache-2.0
// The history of one first map in a store's file: its rows written, read, and made maps of again. What it may hold and
// what not is map_store's business.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/grid/occupancy_grid.hpp"
#include "core/messages.hpp"
#include "mapping/store/database.hpp"
#include "mapping/store/stored_revision.hpp"

namespace deltamap::mapping::store {

inline constexpr std::uint32_t kGridEvery = 64;  ///< revisions between whole grids

/// As the store names maps.
[[nodiscard]] std::int64_t signed_hash(const OccupancyGrid& grid);
/// Neither damaged nor foreign.
[[nodiscard]] bool is_storable(const GridGeometry& geometry);
/// What a list of changes comes to.
[[nodiscard]] StoredRevision summary_of(std::uint32_t number, Timestamp time, const RevisionNote& note,
                                        const std::vector<CellChange>& changes);

/// Every function throws StoreError.
struct History {
  Database database;
  std::int64_t map = 0;  ///< hash of M_0
  GridGeometry geometry;
  std::uint32_t newest = 0;
  std::uint32_t refusals_since_pruning = 0;

  explicit History(Database opened_database) : database{std::move(opened_database)} {}

  [[nodiscard]] bool find_geometry();
  void begin(const OccupancyGrid& first);
  /// Its geometry alone.
  void begin_without_first(const GridGeometry& of_all);
  void remember_as_last_used();
  /// `id`: of the row; nothing: behind all others.
  void write(const StoredRevision& summary, std::int64_t hash, std::span<const std::uint8_t> changes,
             std::span<const std::uint8_t> grid, std::optional<std::int64_t> id = std::nullopt);
  /// A revision that is there leads to this map now.
  void rewrite(std::uint32_t number, const std::vector<CellChange>& changes, const OccupancyGrid& to);
  void append(const MapRevision& revision, const RevisionNote& note, bool whole);
  void prune_refusals();

  [[nodiscard]] std::uint32_t newest_written();
  /// 0: it is the first in the store.
  [[nodiscard]] std::uint32_t number_before(std::uint32_t number);
  /// Later revisions that may have changed something in the box. One that holds others may have changed cells and set
  /// them back, which its own box does not tell.
  [[nodiscard]] std::vector<std::uint32_t> numbers_after(std::uint32_t number, const CellBox& box);
  [[nodiscard]] std::vector<CellChange> changes_of(std::uint32_t number);
  /// M_k from the whole grid at or before it; nothing where something in between is missing or damaged.
  [[nodiscard]] std::optional<OccupancyGrid> restored(std::uint32_t number);
  [[nodiscard]] std::vector<StoredRevision> all();

  [[nodiscard]] std::vector<std::uint32_t> provisional();
  void set_provisional(const std::vector<std::uint32_t>& numbers);

  [[noreturn]] void fail_as_missing(std::uint32_t number) const;
  /// Throws where the revision is no good or was never written.
  [[noreturn]] void fail_to_restore(std::uint32_t number);
};

}  // namespace deltamap::mapping::store
