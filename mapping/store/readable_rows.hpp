// SPDX-License-Identifier: Apache-2.0
// What can be read of a damaged map store: row by row, of the tables and of their copies, so that one that cannot be
// read spoils no other. Only reads.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/grid/occupancy_grid.hpp"
#include "mapping/store/database.hpp"
#include "mapping/store/replaced_first_page.hpp"

namespace deltamap::mapping::store {

struct ReadableRow {
  std::int64_t id = 0;
  std::int64_t map = 0;  ///< hash of M_0
  bool is_refusal = false;
  std::uint32_t number = 0;
  bool is_sure = false;   ///< its checksum says so; else nothing does, but what its map's hash says
  bool has_grid = false;  ///< it is whole
  bool is_named = false;
  std::int64_t time_ns = 0;
  std::int64_t hash = 0;  ///< of M_k
  std::vector<std::uint8_t> changes;
  /// As they were read, null for the changes and the whole map: where a file is damaged, what was found once need not
  /// be found again.
  std::vector<Value> columns{};
  // Where its whole map is read.
  std::size_t source = 0;
  std::string table;
};

class ReadableRows {
 public:
  /// Throws StoreError where nothing can be opened at all.
  explicit ReadableRows(const std::filesystem::path& store);

  struct OfMap {
    std::optional<GridGeometry> geometry;
    std::map<std::uint32_t, ReadableRow> revisions;  ///< of each number the best row
    std::map<std::int64_t, ReadableRow> refusals;    ///< by id
  };
  /// By hash of M_0.
  [[nodiscard]] const std::map<std::int64_t, OfMap>& maps() const { return maps_; }
  /// M_k as it was stored whole; nothing where it is not what its hash says.
  [[nodiscard]] std::optional<OccupancyGrid> grid_of(const ReadableRow& row, const GridGeometry& geometry);
  /// Puts the row into a store as it is, but for its id and its whole map; none where `grid` is empty.
  void copy(const ReadableRow& row, std::int64_t id, Database& target, std::span<const std::uint8_t> grid);
  /// Puts in what the store knows of a map; false where that cannot be read, or tells of another geometry.
  [[nodiscard]] bool copy_map(std::int64_t hash, const GridGeometry& geometry, Database& target);
  /// The map that was used last; 0: none.
  [[nodiscard]] std::int64_t last_used() const;

 private:
  void add_source(const std::filesystem::path& file);
  void read_maps(std::size_t source);
  void read_revisions(std::size_t source);
  [[nodiscard]] std::optional<std::int64_t> read_behind(std::int64_t id, std::size_t source, const std::string& table);
  [[nodiscard]] std::optional<std::int64_t> read_next(std::int64_t id, std::size_t source, const std::string& table);
  void take(ReadableRow row);
  void forget_what_is_known_better();
  [[nodiscard]] bool is_complete();

  struct MapRow {
    std::vector<Value> columns;
    bool is_sure = false;
    std::int64_t used = 0;
  };
  std::unique_ptr<ReplacedFirstPage> replaced_;  // outlives its source
  std::vector<Database> sources_;
  std::map<std::int64_t, OfMap> maps_;
  std::map<std::int64_t, MapRow> map_rows_;
};

}  // namespace deltamap::mapping::store
