// SPDX-License-Identifier: Apache-2.0
#include "mapping/store/readable_rows.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "mapping/store/guarded_rows.hpp"
#include "mapping/store/history.hpp"
#include "mapping/store/map_codec.hpp"
#include "mapping/store/store_schema.hpp"

namespace deltamap::mapping::store {
namespace {

constexpr std::int64_t kBeyondDamage = 20'000;  // rows that are looked for behind the last that is found

/// As an older version, or damage, has left it: what has no column is NULL, and what has no checksum is not sure.
std::string selection(Database& database, const std::string& table, Table kind) {
  const std::string columns{guarded(kind).columns};
  const std::string present = selected(database, table, columns);
  const bool has_sums = selected(database, table, "checksum") == "checksum" && present == columns;
  return "SELECT " + present + ", " + (has_sums ? "checksum IS row_sum(" + columns + ")" : std::string("0")) +
         " FROM " + table + " NOT INDEXED";
}

constexpr int kMapUsed = 6;    // columns of `map`
constexpr int kMapIsSure = 8;  // behind them

enum Column : int {  // of `revision`, and behind them
  kColumnId,
  kColumnMap,
  kColumnNumber,
  kColumnRefused,
  kColumnTime,
  kColumnPhase,
  kColumnAcceptance,
  kColumnCause,
  kColumnOccupied,
  kColumnFreed,
  kColumnUnknown,
  kColumnFirstColumn,
  kColumnFirstRow,
  kColumnLastColumn,
  kColumnLastRow,
  kColumnHash,
  kColumnChanges,
  kColumnGrid,
  kColumnXx,
  kColumnXy,
  kColumnXh,
  kColumnYy,
  kColumnYh,
  kColumnHh,
  kColumnName,
  kColumnIsSure
};

std::vector<Value> columns_of(const Statement& row, int count) {
  std::vector<Value> columns;
  columns.reserve(static_cast<std::size_t>(count));
  for (int column = 0; column < count; ++column) columns.push_back(row.value(column));
  return columns;
}

/// All but what may be large.
std::vector<Value> small_columns_of(const Statement& row) {
  std::vector<Value> columns(kColumnIsSure);
  for (int column = 0; column < kColumnIsSure; ++column) {
    if (column != kColumnChanges && column != kColumnGrid)
      columns[static_cast<std::size_t>(column)] = row.value(column);
  }
  return columns;
}

ReadableRow row_in(const Statement& row, std::size_t source, const std::string& table) {
  return {.id = row.number(kColumnId),
          .map = row.number(kColumnMap),
          .is_refusal = row.number(kColumnRefused) != 0,
          .number = static_cast<std::uint32_t>(row.number(kColumnNumber)),
          .is_sure = row.number(kColumnIsSure) != 0,
          .has_grid = !row.is_null(kColumnGrid),
          .is_named = !row.is_null(kColumnName),
          .time_ns = row.number(kColumnTime),
          .hash = row.number(kColumnHash),
          .changes = row.blob(kColumnChanges),
          .columns = small_columns_of(row),
          .source = source,
          .table = table};
}

/// A sure one before others, and of these one that is whole.
template <typename Key>
void keep_better(std::map<Key, ReadableRow>& rows, Key key, ReadableRow row) {
  const auto [there, is_new] = rows.try_emplace(key, row);
  if (is_new) return;
  const ReadableRow& old = there->second;
  if (std::pair{row.is_sure, row.has_grid} > std::pair{old.is_sure, old.has_grid}) there->second = std::move(row);
}

/// Where nothing can be written beside the file, its log cannot be taken into account: it is read as it is.
std::optional<Database> opened(const std::filesystem::path& file) {
  for (const auto mode : {Database::Mode::kRead, Database::Mode::kReadAsIs}) {
    try {
      Database database{file, mode};
      database.run("PRAGMA writable_schema = ON");  // what is damaged in it spoils no other table
      (void)database.number("SELECT count(*) FROM sqlite_master");
      return database;
    } catch (const StoreError&) {  // the next way, or none
    }
  }
  return std::nullopt;
}

}  // namespace

ReadableRows::ReadableRows(const std::filesystem::path& store) {
  add_source(store);
  if (!is_complete()) {
    try {
      replaced_ = std::make_unique<ReplacedFirstPage>(store);
      add_source(replaced_->file());
    } catch (const std::exception&) {  // no room for a copy: what could be read without one
    }
  }
  forget_what_is_known_better();
}

/// A damaged row may tell of another number or map than its copy, or than it does itself.
void ReadableRows::forget_what_is_known_better() {
  std::set<std::int64_t> sure;
  const auto visit = [](OfMap& of_map, auto&& act) {
    act(of_map.revisions);
    act(of_map.refusals);
  };
  for (auto& [hash, of_map] : maps_) {
    visit(of_map, [&](const auto& rows) {
      for (const auto& [key, row] : rows) {
        if (row.is_sure) sure.insert(row.id);
      }
    });
  }
  for (auto& [hash, of_map] : maps_) {
    visit(of_map, [&](auto& rows) {
      std::erase_if(rows, [&](const auto& one) { return !one.second.is_sure && sure.contains(one.second.id); });
    });
  }
}

/// Its first page tells of all tables.
bool ReadableRows::is_complete() {
  if (sources_.empty() || maps_.empty()) return false;
  Database& database = sources_.front();
  const auto has = [&](const char* table) {
    return database.number("SELECT count(*) FROM pragma_table_info('" + std::string(table) + "')") > 0;
  };
  try {
    const bool is_old = database.number("PRAGMA user_version") < kSchemaVersion;
    return has("map") && has("revision") && (is_old || (has("map_copy") && has("revision_copy")));
  } catch (const StoreError&) {
    return false;
  }
}

void ReadableRows::add_source(const std::filesystem::path& file) {
  auto database = opened(file);
  if (!database) return;
  sources_.push_back(*std::move(database));
  read_maps(sources_.size() - 1);
  read_revisions(sources_.size() - 1);
}

void ReadableRows::read_maps(std::size_t source) {
  Database& database = sources_[source];
  for (const std::string_view name : {guarded(Table::kMap).name, guarded(Table::kMap).copy}) {
    const std::string table{name};
    try {
      Statement row{database, selection(database, table, Table::kMap)};
      while (row.step()) {
        const std::int64_t hash = row.number(0);
        const bool is_sure = row.number(kMapIsSure) != 0;
        const GridGeometry geometry{static_cast<int>(row.number(1)), static_cast<int>(row.number(2)), row.real(3),
                                    Point2{row.real(4), row.real(5)}};
        const auto old = map_rows_.find(hash);
        if (!is_storable(geometry) || (old != map_rows_.end() && old->second.is_sure >= is_sure)) continue;
        map_rows_[hash] = {columns_of(row, kMapIsSure), is_sure, row.number(kMapUsed)};
        maps_[hash].geometry = geometry;
      }
    } catch (const StoreError&) {  // the copy, or the next source
    }
  }
}

void ReadableRows::read_revisions(std::size_t source) {
  for (const std::string_view name : {guarded(Table::kRevision).name, guarded(Table::kRevision).copy}) {
    const std::string table{name};
    std::optional<std::int64_t> last = 0;
    while (last) {
      last = read_behind(*last, source, table);  // up to what cannot be read,
      if (last) last = read_next(*last, source, table);
    }
  }
}

/// Up to the first row that cannot be read: answers the one before it; nothing at the end.
std::optional<std::int64_t> ReadableRows::read_behind(std::int64_t id, std::size_t source, const std::string& table) {
  try {
    Database& database = sources_[source];
    Statement rows{database, selection(database, table, Table::kRevision) + " WHERE id > ? ORDER BY id"};
    rows.bind(id);
    while (rows.step()) {
      id = std::max(id, rows.number(kColumnId));
      take(row_in(rows, source, table));
    }
    return std::nullopt;
  } catch (const StoreError&) {
    return id;
  }
}

/// The next one that can be read, one by one; nothing where there is none, or no such table.
std::optional<std::int64_t> ReadableRows::read_next(std::int64_t id, std::size_t source, const std::string& table) {
  try {
    Database& database = sources_[source];
    Statement row{database, selection(database, table, Table::kRevision) + " WHERE id = ?"};
    for (const std::int64_t end = id + kBeyondDamage; ++id <= end;) {
      if (!row.finds(id)) continue;
      take(row_in(row, source, table));
      return id;
    }
  } catch (const StoreError&) {  // the table itself cannot be read
  }
  return std::nullopt;
}

void ReadableRows::take(ReadableRow row) {
  OfMap& of_map = maps_[row.map];
  if (row.is_refusal) {
    const std::int64_t id = row.id;
    keep_better(of_map.refusals, id, std::move(row));
  } else {
    const std::uint32_t number = row.number;
    keep_better(of_map.revisions, number, std::move(row));
  }
}

/// By its place, else on a way through the whole table: damage may be on the one and not on the other.
std::optional<OccupancyGrid> ReadableRows::grid_of(const ReadableRow& row, const GridGeometry& geometry) {
  if (!row.has_grid) return std::nullopt;
  for (const std::string id : {"id", "+id"}) {
    try {
      Statement read{sources_[row.source], "SELECT grid FROM " + row.table + " NOT INDEXED WHERE " + id + " = ?"};
      read.bind(row.id);
      if (!read.step()) continue;
      auto grid = decoded_grid(read.blob(0), geometry);
      if (grid && signed_hash(*grid) == row.hash) return grid;
    } catch (const StoreError&) {  // the other way, or none
    }
  }
  return std::nullopt;
}

void ReadableRows::copy(const ReadableRow& row, std::int64_t id, Database& target, std::span<const std::uint8_t> grid) {
  std::string places = "?";
  for (int column = 1; column < kColumnIsSure; ++column) places += ", ?";
  Statement write{
      target, "INSERT INTO revision (" + std::string(guarded(Table::kRevision).columns) + ") VALUES (" + places + ")"};
  for (int column = 0; column < kColumnIsSure; ++column) {
    if (column == kColumnId) {
      write.bind(id);
    } else if (column == kColumnMap) {
      write.bind(row.map);
    } else if (column == kColumnNumber) {
      write.bind(std::int64_t{row.number});
    } else if (column == kColumnRefused) {
      write.bind(std::int64_t{row.is_refusal});
    } else if (column == kColumnChanges) {
      write.bind(row.changes);
    } else if (column == kColumnGrid) {
      write.bind(grid);
    } else {
      write.bind(row.columns[static_cast<std::size_t>(column)]);
    }
  }
  write.step();
  guard(target, Table::kRevision, "id = " + std::to_string(id));
}

bool ReadableRows::copy_map(std::int64_t hash, const GridGeometry& geometry, Database& target) {
  const auto found = map_rows_.find(hash);
  if (found == map_rows_.end() || maps_[hash].geometry != geometry) return false;
  Statement write{
      target, "INSERT INTO map (" + std::string(guarded(Table::kMap).columns) + ") VALUES (?, ?, ?, ?, ?, ?, ?, ?)"};
  for (const Value& column : found->second.columns) write.bind(column);
  write.step();
  guard(target, Table::kMap, "hash = " + std::to_string(hash));
  return true;
}

std::int64_t ReadableRows::last_used() const {
  const auto last = std::max_element(map_rows_.begin(), map_rows_.end(), [](const auto& one, const auto& other) {
    return std::pair{one.second.is_sure, one.second.used} < std::pair{other.second.is_sure, other.second.used};
  });
  return last == map_rows_.end() ? 0 : last->first;
}

}  // namespace deltamap::mapping::store
