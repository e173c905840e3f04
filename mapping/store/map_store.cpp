// SPDX-License-Identifier: Apache-2.0
#include "mapping/store/map_store.hpp"

#include <algorithm>
#include <utility>

#include "mapping/store/database.hpp"
#include "mapping/store/history.hpp"
#include "mapping/store/map_codec.hpp"
#include "mapping/store/revision_names.hpp"
#include "mapping/store/store_recovery.hpp"
#include "mapping/store/store_retention.hpp"
#include "mapping/store/store_schema.hpp"
#include "mapping/store/taken_back.hpp"

namespace deltamap::mapping::store {
namespace {

constexpr std::uint32_t kPruneEvery = 100;  // refusals: looking for the oldest reads through many

}  // namespace

MapStore::MapStore(const std::filesystem::path& file, const OccupancyGrid& first)
    : MapStore{std::make_unique<History>(opened_store(file, Database::Mode::kCreate)), first} {}

MapStore::MapStore(std::unique_ptr<History> opened, const OccupancyGrid& first) : history_{std::move(opened)} {
  History& h = *history_;
  Transaction all{h.database};
  h.map = signed_hash(first);
  if (!h.find_geometry()) h.begin(first);
  h.remember_as_last_used();
  h.newest = h.newest_written();
  if (!h.restored(h.newest)) h.fail_to_restore(h.newest);
  h.prune_refusals();
  all.commit();
}

MapStore::MapStore(std::unique_ptr<History> opened) : history_{std::move(opened)} {
  History& h = *history_;
  if (h.database.number("SELECT count(*) FROM map") == 0) h.database.fail("holds no map yet");
  h.map = h.database.number("SELECT hash FROM map ORDER BY used DESC LIMIT 1");
  (void)h.find_geometry();
  h.newest = h.newest_written();
}

MapStore::MapStore(const std::filesystem::path& file)
    : MapStore{std::make_unique<History>(opened_store(file, Database::Mode::kExisting))} {}

MapStore MapStore::to_read(const std::filesystem::path& file) {
  const auto mode = is_read_as_is(file) ? Database::Mode::kReadAsIs : Database::Mode::kExisting;
  try {
    return MapStore{std::make_unique<History>(opened_store(file, mode))};
  } catch (const StoreError& error) {
    const bool is_damaged = error.kind == StoreError::Kind::kUnsound;
    const bool is_old = mode == Database::Mode::kReadAsIs && error.kind == StoreError::Kind::kReadOnly;
    if (!is_damaged && !is_old) throw;
    auto history = std::make_unique<History>(opened_store(file, Database::Mode::kMemory));
    const Recovery recovery = recover(file, nullptr, *history);
    if (recovery.revisions == 0) throw;
    MapStore store{std::move(history)};
    if (is_damaged) store.damage_ = std::string(error.what()) + "; " + recovery.words();
    return store;
  }
}

MapStore MapStore::in_memory(const std::filesystem::path& file, const OccupancyGrid& first) {
  auto history = std::make_unique<History>(opened_store(file, Database::Mode::kMemory));
  (void)recover(file, &first, *history);
  return MapStore{std::move(history), first};
}

MapStore::~MapStore() = default;
MapStore::MapStore(MapStore&&) noexcept = default;
MapStore& MapStore::operator=(MapStore&&) noexcept = default;

std::uint32_t MapStore::newest() const { return history_->newest; }

std::uint32_t MapStore::revisions_of_others() const {
  Statement row{history_->database, "SELECT count(*) FROM revision WHERE map != ? AND refused = 0 AND number > 0"};
  row.bind(history_->map);
  return row.step() ? static_cast<std::uint32_t>(row.number(0)) : 0;
}
void MapStore::catch_up() { history_->newest = history_->newest_written(); }

OccupancyGrid MapStore::grid(std::uint32_t number) const {
  if (number > history_->newest) history_->fail_as_missing(number);
  auto grid = history_->restored(number);
  if (!grid) history_->fail_to_restore(number);
  return *std::move(grid);
}

std::vector<StoredRevision> MapStore::history() const { return history_->all(); }

void MapStore::append(const MapRevision& revision, const RevisionNote& note) {
  History& s = *history_;
  if (revision.number != s.newest + 1) {
    s.database.fail("revision " + std::to_string(revision.number) + " does not follow " + std::to_string(s.newest));
  }
  s.append(revision, note, revision.number % kGridEvery == 0);
}

void MapStore::append_whole(std::uint32_t number, Timestamp time, const OccupancyGrid& map, const RevisionNote& note) {
  if (number <= newest()) history_->database.fail("revision " + std::to_string(number) + " is older than the newest");
  MapRevision revision;
  revision.number = number;
  revision.time = time;
  revision.changes = changes_between(grid(newest()), map);
  revision.map = std::make_shared<const OccupancyGrid>(map);
  history_->append(revision, note, true);
}

void MapStore::append_refusal(Timestamp time, const RevisionNote& note) {
  StoredRevision refusal;
  refusal.number = history_->newest;
  refusal.refused = true;
  refusal.time = time;
  refusal.note = note;
  Transaction all{history_->database};
  history_->write(refusal, 0, {}, {});
  if (note.provisional) history_->set_provisional(*note.provisional);
  if (++history_->refusals_since_pruning >= kPruneEvery) history_->prune_refusals();
  all.commit();
}

std::uint32_t MapStore::roll_back(std::uint32_t number, Timestamp time) {
  MapRevision revision;
  revision.number = history_->newest + 1;
  revision.time = time;
  revision.map = std::make_shared<const OccupancyGrid>(grid(number));
  revision.changes = changes_between(grid(history_->newest), *revision.map);
  append(revision, {.cause = "rolled back to " + std::to_string(number)});
  return revision.number;
}

/// What was missed while the store could not be written, or thinned out, is in the next one that it holds.
std::vector<std::uint32_t> MapStore::provisional() const {
  std::vector<std::uint32_t> held;
  for (const std::uint32_t number : history_->provisional()) {
    Statement row{history_->database, "SELECT min(number) FROM revision WHERE map = ? AND refused = 0 AND number >= ?"};
    row.bind(history_->map).bind(std::int64_t{number});
    if (!row.step() || row.is_null(0)) continue;
    const auto in_store = static_cast<std::uint32_t>(row.number(0));
    if (held.empty() || held.back() != in_store) held.push_back(in_store);
  }
  return held;
}

void MapStore::set_provisional(const std::vector<std::uint32_t>& numbers) {
  Transaction all{history_->database};
  history_->set_provisional(numbers);
  all.commit();
}

std::vector<CellChange> MapStore::changes(std::uint32_t number) const {
  if (number > history_->newest) history_->fail_as_missing(number);
  if (number == 0) return {};
  std::vector<CellChange> changes = history_->changes_of(number);
  std::erase_if(changes, [](const CellChange& change) { return change.before == change.after; });
  return changes;
}

bool MapStore::thin_out(const Retention& retention, Timestamp now) {
  History& s = *history_;
  const std::vector<std::uint32_t> provisional = s.provisional();
  return store::thin_out(s.database, s.map, s.geometry, retention, provisional.empty() ? 0 : provisional.front(), now);
}

void MapStore::set_name(std::uint32_t number, const std::string& name) {
  write_name(history_->database, history_->map, number, name, encoded_grid(grid(number)));
}

MapStore::Undoing MapStore::undoing(std::uint32_t number, const OccupancyGrid& newest_map) const {
  History& s = *history_;
  if (number == 0) s.database.fail("revision 0 is the first map: there is nothing to undo");
  std::vector<CellChange> delta = changes(number);
  const std::size_t all = delta.size();
  std::vector<bool> changed_later(s.geometry.cell_count(), false);
  for (const std::uint32_t later : s.numbers_after(number, bounding_box(delta))) {
    for (const CellChange& change : s.changes_of(later)) changed_later[s.geometry.index_of(change.cell)] = true;
  }
  std::erase_if(delta, [&](const CellChange& change) { return changed_later[s.geometry.index_of(change.cell)]; });

  Undoing undoing{.changes = taken_back(newest_map, delta)};
  if (undoing.changes.empty()) {
    s.database.fail("nothing of revision " + std::to_string(number) + " is left to undo");
  }
  undoing.kept = all - undoing.changes.size();
  undoing.held_before = number - s.number_before(number) - 1;
  return undoing;
}

std::uint32_t MapStore::undo(std::uint32_t number, Timestamp time) {
  OccupancyGrid map = grid(history_->newest);
  MapRevision revision;
  revision.number = history_->newest + 1;
  revision.time = time;
  revision.changes = undoing(number, map).changes;
  revision.map = std::make_shared<const OccupancyGrid>(patched(std::move(map), revision.changes));
  append(revision, {.cause = "undo of " + std::to_string(number)});
  return revision.number;
}

}  // namespace deltamap::mapping::store
