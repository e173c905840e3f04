// SPDX-License-Identifier: Apache-2.0
#include "daemon/maps/revision_keeper.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>
#include <vector>

namespace deltamap::daemon {
namespace {

constexpr Duration kLookForOld =
    std::chrono::minutes(1);  // a look reads an index; what it finds is 64 revisions at most

/// Turns revision numbers of this run into those of the store; revisions from before the store are left out.
std::vector<std::uint32_t> numbers_in_store(const std::vector<std::uint32_t>& numbers, std::uint32_t numbers_before) {
  std::vector<std::uint32_t> in_store;
  for (const std::uint32_t number : numbers) {
    const std::int64_t stored = std::int64_t{number} - static_cast<std::int32_t>(numbers_before);
    if (stored > 0) in_store.push_back(static_cast<std::uint32_t>(stored));
  }
  return in_store;
}

mapping::store::RevisionNote note_of(const MapStep::Result& result, std::string_view method,
                                     std::uint32_t numbers_before) {
  const ChangeNote& note = result.note;
  return {.phase = note.phase,
          .acceptance = note.acceptance,
          .cause = result.revision && note.reason.empty() ? std::string(method) : note.reason,
          .covariance = note.by_operator ? std::nullopt : std::optional{note.covariance},
          .provisional = numbers_in_store(result.provisional, numbers_before)};
}

}  // namespace

void keep(mapping::store::MapStore& store, const MapStep::Result& result, std::string_view method,
          std::uint32_t numbers_before) {
  const mapping::store::RevisionNote note = note_of(result, method, numbers_before);
  if (!result.revision) return store.append_refusal(result.note.time, note);
  MapRevision revision = *result.revision;
  revision.number -= numbers_before;
  store.append(revision, note);
}

RevisionKeeper::RevisionKeeper(StoreToKeep store, std::string_view method, RetryingOutput output, Timestamp now)
    : to_{std::move(store)}, method_{method}, output_{std::move(output)} {
  if (!to_.store && to_.why_not.empty()) store_waiting(now);
  if (!to_.why_not.empty()) output_.fail(now, to_.why_not);
}

void RevisionKeeper::settle(Timestamp now) {
  missed_settlement_ = true;
  store_waiting(now);
}

void RevisionKeeper::take(const MapStep::Result& result, Timestamp now) {
  missed_settlement_ = false;  // the result lists anew which revisions are provisional
  const bool all_stored = to_.store && !missed_revision_ && !missed_refusal_;
  const bool goes_on = all_stored && (!result.revision || follows(*result.revision));
  const auto append = [&] {
    lock();
    keep(*to_.store, result, method_, to_.numbers_before);
  };
  if (goes_on && output_.attempt(now, append)) return;
  miss(result);
  store_waiting(now);
}

bool RevisionKeeper::follows(const MapRevision& revision) const {
  return revision.number - to_.numbers_before == to_.store->newest() + 1;
}

mapping::store::MapStore::Undoing RevisionKeeper::cells_of(const MapOrder& order,
                                                           const OccupancyGrid& newest_map) const {
  if (const std::string why = why_behind(); !why.empty()) {
    throw std::runtime_error("the newest revisions are not in the store yet: " + why);
  }
  const std::uint32_t number = number_in_store(order.revision);
  if (order.kind == MapOrder::Kind::kUndo) return to_.store->undoing(number, newest_map);
  std::vector<CellChange> changes = changes_between(newest_map, to_.store->grid(number));
  if (changes.empty()) {
    throw std::runtime_error("the map is as revision " + std::to_string(order.revision) + " was: nothing to do");
  }
  return {.changes = std::move(changes)};
}

std::uint32_t RevisionKeeper::number_in_store(std::uint32_t revision) const {
  const std::int64_t number = std::int64_t{revision} - static_cast<std::int32_t>(to_.numbers_before);
  if (number >= 0) return static_cast<std::uint32_t>(number);
  throw std::runtime_error("revision " + std::to_string(revision) + " is of a run before: only a map.store knows it");
}

std::string RevisionKeeper::why_behind() const {
  if (to_.store && !missed_revision_) return {};
  return output_.works() ? "it is tried again in a moment" : output_.why();
}

void RevisionKeeper::lock() {
  if (!to_.lock && !to_.to_lock.empty()) to_.lock = lock_of_file(to_.to_lock);
}

void RevisionKeeper::miss(const MapStep::Result& result) {
  if (!result.revision) {
    if (missed_refusal_) output_.count_lost();
    missed_refusal_ = result;
    return;
  }
  const std::uint32_t first = missed_revision_ ? missed_revision_->first : result.revision->number;
  missed_revision_ = Missed{first, result};
  missed_revision_->newest.revision->changes.clear();
  missed_revision_->newest.revision->field_patch = {};
}

void RevisionKeeper::retry(Timestamp now) {
  store_waiting(now);
  thin_out(now);
}

/// Looks for old revisions once a period, and at once where the clock has jumped back.
void RevisionKeeper::thin_out(Timestamp now) {
  if (to_.retention.keeps_all() || !why_behind().empty()) return;
  if (looked_for_old_ && now >= *looked_for_old_ && now - *looked_for_old_ < kLookForOld) return;
  bool found = false;
  const auto look = [&] {
    lock();
    found = to_.store->thin_out(to_.retention, now);
  };
  if (!output_.attempt(now, look)) return;
  looked_for_old_.reset();
  if (!found) looked_for_old_ = now;
}

void RevisionKeeper::store_waiting(Timestamp now) {
  const bool is_locked = to_.lock || to_.to_lock.empty();
  if (to_.store && is_locked && !missed_revision_ && !missed_refusal_ && !missed_settlement_) return;
  (void)output_.attempt(now, [this] { store_missed(); });
}

void RevisionKeeper::close(Timestamp now) {
  output_.hurry();
  store_waiting(now);
}

void RevisionKeeper::store_missed() {
  lock();
  if (!to_.store) to_.store.emplace(to_.open());
  if (missed_revision_) {
    store_whole(*missed_revision_);
    missed_revision_.reset();
  }
  if (missed_refusal_) {
    keep(*to_.store, *missed_refusal_, method_, to_.numbers_before);
    missed_refusal_.reset();
  }
  if (missed_settlement_) {
    to_.store->set_provisional({});
    missed_settlement_ = false;
  }
}

/// Appends the whole map behind the store's newest revision: a store that could be opened only now, or that another
/// program has written to, holds revisions that this run does not know of.
void RevisionKeeper::store_whole(const Missed& missed) {
  mapping::store::MapStore& store = *to_.store;
  store.catch_up();
  const MapRevision& newest = *missed.newest.revision;
  const std::uint32_t first = std::max(missed.first - to_.numbers_before, store.newest() + 1);
  const std::uint32_t numbers_before = missed.first - first;
  const std::uint32_t number = newest.number - numbers_before;
  mapping::store::RevisionNote note = note_of(missed.newest, method_, numbers_before);
  if (first < number) note.cause += " (" + std::to_string(first) + " to " + std::to_string(number) + " in one)";
  store.append_whole(number, newest.time, *newest.map, note);
  to_.numbers_before = numbers_before;
}

}  // namespace deltamap::daemon
