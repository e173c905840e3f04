// SPDX-License-Identifier: Apache-2.0
#include "daemon/maps/store_opening.hpp"

#include <chrono>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "core/counted.hpp"
#include "core/files/replace_file.hpp"
#include "daemon/kept/kept_pose.hpp"
#include "daemon/outputs/output_place.hpp"
#include "daemon/settings/memory_places.hpp"
#include "daemon/settings/start_error.hpp"
#include "daemon/system/service.hpp"
#include "mapping/store/database_log.hpp"
#include "mapping/store/store_error.hpp"
#include "mapping/store/store_recovery.hpp"

namespace deltamap::daemon {
namespace {

namespace fs = std::filesystem;
using mapping::store::MapStore;
using mapping::store::Recovery;
using mapping::store::StoreError;

constexpr std::chrono::minutes kLongestOpening{20};  // else systemd would kill a long recovery at each start

/// Renames the database with its log to the first free name NAME.set-aside-1, -2 …; nullopt where that fails. The log
/// goes first: a new database of the old name must never find it.
std::optional<fs::path> set_aside(const fs::path& file) {
  std::error_code error;
  fs::path aside;
  int number = 1;
  do {
    aside = file.string() + ".set-aside-" + std::to_string(number++);
  } while (fs::exists(fs::symlink_status(aside, error)));
  const auto [log, index] = mapping::store::log_of(file);
  const auto [log_aside, index_aside] = mapping::store::log_of(aside);
  fs::rename(log, log_aside, error);
  fs::rename(index, index_aside, error);
  fs::rename(file, aside, error);
  if (error) return std::nullopt;
  return aside;
}

/// The name of a recovered store that is complete and still has to be renamed to `file`.
fs::path recovered_name(const fs::path& file) { return file.string() + ".recovered"; }

void put_in_place(const fs::path& file) { move_into_place(recovered_name(file), file); }

/// Puts a recovered store in place where an earlier start was killed between recovering and renaming.
void finish_recovery(const fs::path& file) {
  std::error_code ignored;
  if (!fs::exists(recovered_name(file), ignored)) return;
  if (fs::exists(file, ignored)) (void)set_aside(file);
  put_in_place(file);
}

struct Recovered {
  fs::path aside;
  Recovery recovery;
};

/// Recovers what is readable of a damaged store into a new one beside it (recovered_name). Throws std::runtime_error
/// where that cannot be written.
Recovery made_whole(const fs::path& file, const OccupancyGrid& first) {
  const fs::path draft = file.string() + ".recovering";
  const auto [log, index] = mapping::store::log_of(draft);
  const auto remove_draft = [&, log = log, index = index] {
    std::error_code ignored;
    for (const fs::path& part : {draft, log, index}) fs::remove(part, ignored);
  };
  remove_draft();
  try {
    Recovery recovery = mapping::store::recover(file, first, draft);
    if (fs::exists(log)) throw std::runtime_error(draft.string() + ": its log cannot be written into it");
    move_into_place(draft, recovered_name(file));
    return recovery;
  } catch (...) {
    remove_draft();
    throw;
  }
}

/// A file that was emptied is a new store to SQLite, which would delete the log beside it.
MapStore begun_in_place_of_emptied(const fs::path& file, const OccupancyGrid& first, std::uint32_t known,
                                   std::vector<std::string>& warnings) {
  const auto aside = set_aside(file);
  if (!aside) throw StoreError(file.string() + ": is empty, and cannot be renamed", StoreError::Kind::kOther);
  warnings.push_back("map store set aside as " + aside->string() + ": " + file.string() + ": is empty; " +
                     Recovery{.known = known}.words());
  return MapStore{file, first};
}

/// The store in its place, sound; a line is added to `warnings` where that took a recovery, or revisions that are known
/// to have been written are not there. Throws StoreError.
MapStore sound_store(const fs::path& file, const OccupancyGrid& first, std::uint32_t known,
                     std::vector<std::string>& warnings) {
  if (was_emptied(file, known)) return begun_in_place_of_emptied(file, first, known, warnings);
  std::string reason;
  try {
    MapStore store{file, first};
    if (std::string missing = words_of_missing(store.newest(), known); !missing.empty())
      warnings.push_back("map store: " + missing);
    return store;
  } catch (const StoreError& error) {
    if (error.kind == StoreError::Kind::kOther) throw;
    reason = error.what();
  }
  try {
    Recovery recovery = made_whole(file, first);
    recovery.known = known;
    const auto aside = set_aside(file);
    if (!aside) throw std::runtime_error(file.string() + ": cannot be renamed");
    put_in_place(file);
    warnings.push_back("map store set aside as " + aside->string() + ": " + reason + "; " + recovery.words());
    return MapStore{file, first};
  } catch (const std::runtime_error& error) {
    throw StoreError(reason + "; no other store can be written: " + error.what(), StoreError::Kind::kOther);
  }
}

StartMap start_on(const MapStore& store) {
  StartMap start{.map = std::make_shared<const OccupancyGrid>(store.grid(store.newest())), .revision = store.newest()};
  for (const std::uint32_t number : store.provisional()) start.provisional.push_back({number, store.changes(number)});
  return start;
}

void take(OpenedStore& opened, MapStore store) {
  if (const std::string others = words_of_others(store); !others.empty())
    opened.warnings.push_back("map store: " + others);
  opened.start = start_on(store);
  opened.store.store = std::move(store);
}

/// Where a run begins whose store can be read but not written.
struct ReadStart {
  StartMap start;
  Timestamp time;  ///< of its revision
};

/// The start from a store that is only read; nullopt where it holds no revision of this first map.
std::optional<ReadStart> read_start(const fs::path& file, const OccupancyGrid& first) {
  try {
    const MapStore store = MapStore::in_memory(file, first);
    if (store.newest() == 0) return std::nullopt;
    ReadStart read{start_on(store), {}};
    for (const auto& revision : store.history()) {
      if (!revision.refused && revision.number == read.start.revision) read.time = revision.time;
    }
    return read;
  } catch (const StoreError&) {
    return std::nullopt;
  }
}

/// Begins the run with what can be read of a store that cannot be written; it is opened as soon as that is possible.
void go_on_without(OpenedStore& opened, const fs::path& file, const OccupancyGrid& first, std::uint32_t known,
                   const std::string& reason) {
  const auto read = read_start(file, first);
  opened.start = read ? read->start : StartMap{.map = std::make_shared<const OccupancyGrid>(first)};
  opened.warnings.push_back("map store cannot be written: " + reason + "; " +
                            (read ? "goes on with its revision=" + std::to_string(read->start.revision)
                                  : "nothing of this map can be read in it: begins with the first map"));
  if (std::string missing = words_of_missing(opened.start.revision, known); !missing.empty())
    opened.warnings.push_back("map store: " + missing);
  opened.store.why_not = reason;
  opened.store.open = [file, read, known, first = std::make_shared<const OccupancyGrid>(first)] {
    std::vector<std::string> told_before;
    MapStore store = sound_store(file, *first, known, told_before);
    if (read && store.newest() < read->start.revision) {
      store.append_whole(read->start.revision, read->time, *read->start.map, {.cause = "read before it was written"});
    }
    return store;
  };
}

}  // namespace

std::string words_of_others(const MapStore& store) {
  const std::uint32_t others = store.newest() == 0 ? store.revisions_of_others() : 0;
  if (others == 0) return "";
  return "holds " + counted(others, "revision") +
         " of another first map and none of this one: begins with the first map";
}

std::uint32_t known_revision(const fs::path& store, const OccupancyGrid& first) {
  return read_kept_pose(memory_places(store).pose, grid_hash(first)).revision;
}

std::string words_of_missing(std::uint32_t newest, std::uint32_t known) {
  if (known <= newest) return "";
  const std::string range = known == newest + 1 ? std::to_string(known) + " is"
                                                : std::to_string(newest + 1) + " to " + std::to_string(known) + " are";
  return "its newest revision of this map is " + std::to_string(newest) +
         ", and the pose that was kept is of revision " + std::to_string(known) + ": " + range + " missing";
}

bool was_emptied(const fs::path& store, std::uint32_t known) {
  const auto is_there = [](const fs::path& file) {
    std::error_code error;
    return fs::is_regular_file(file, error) ? std::optional{fs::file_size(file, error)} : std::nullopt;
  };
  return is_there(store) == 0u && (known > 0 || is_there(mapping::store::log_of(store).log).value_or(0) > 0);
}

OpenedStore open_store(const fs::path& name, const OccupancyGrid& first) {
  (void)judged_store_place(name);
  // A link is followed: lock, open and set aside act on the database itself. Where it cannot be told whether another
  // program has it locked, the start ends and the file stays untouched.
  const fs::path file = or_start_error([&] { return file_behind(name); });
  service::ask_for_time(kLongestOpening);
  const std::uint32_t known = known_revision(name, first);
  OpenedStore opened;
  opened.store.to_lock = file;
  opened.store.lock = or_start_error([&] { return lock_of_file(file); });
  try {
    finish_recovery(file);
    take(opened, sound_store(file, first, known, opened.warnings));
  } catch (const std::runtime_error& error) {
    go_on_without(opened, file, first, known, error.what());
  }
  return opened;
}

}  // namespace deltamap::daemon
