// SPDX-License-Identifier: Apache-2.0
#include "daemon/maps/store_opening.hpp"

#include <system_error>
#include <utility>

#include "daemon/outputs/output_place.hpp"
#include "daemon/settings/start_error.hpp"
#include "mapping/store/database_log.hpp"
#include "mapping/store/map_salvage.hpp"
#include "mapping/store/store_error.hpp"

namespace deltamap::daemon {
namespace {

namespace fs = std::filesystem;
using mapping::store::MapStore;
using mapping::store::SalvagedMap;
using mapping::store::StoreError;

/// The database with its log, under the first free name NAME.set-aside-1, -2 …; nothing where it cannot be renamed.
std::optional<fs::path> set_aside(const fs::path& file) {
  std::error_code error;
  fs::path aside;
  int number = 1;
  do {
    aside = file.string() + ".set-aside-" + std::to_string(number++);
  } while (fs::exists(fs::symlink_status(aside, error)));
  fs::rename(file, aside, error);
  if (error) return std::nullopt;
  const auto [log, index] = mapping::store::log_of(file);
  const auto [log_aside, index_aside] = mapping::store::log_of(aside);
  fs::rename(log, log_aside, error);
  fs::rename(index, index_aside, error);
  return aside;
}

StartMap start_on(const OccupancyGrid& first, const std::optional<SalvagedMap>& saved) {
  if (!saved) return {std::make_shared<const OccupancyGrid>(first), 0};
  return {std::make_shared<const OccupancyGrid>(saved->grid), saved->number};
}

/// Opens the store, and brings it to where the old one ended.
MapStore brought_forward(const fs::path& file, const OccupancyGrid& first, const std::optional<SalvagedMap>& saved) {
  MapStore store{file, first};
  if (saved && store.newest() < saved->number) {
    store.append_whole(saved->number, saved->time, saved->grid, {.cause = "saved from a store that was set aside"});
  }
  return store;
}

void take(OpenedStore& opened, MapStore store, const OccupancyGrid& first) {
  if (store.dropped() > 0) {
    opened.warnings.push_back("map store: damaged revisions dropped=" + std::to_string(store.dropped()));
  }
  const std::uint32_t newest = store.newest();
  if (const std::string others = words_of_others(store); !others.empty())
    opened.warnings.push_back("map store: " + others);
  opened.start = {std::make_shared<const OccupancyGrid>(newest == 0 ? first : store.grid(newest)), newest};
  opened.store.store = std::move(store);
}

/// The store cannot be used as it is.
void go_on_without(OpenedStore& opened, const fs::path& file, const OccupancyGrid& first, const StoreError& reason) {
  const auto saved = mapping::store::newest_whole_map(file, first);
  const auto aside = reason.kind == StoreError::Kind::kOther ? std::nullopt : set_aside(file);
  opened.start = start_on(first, saved);
  const std::string from = saved ? "goes on with its revision=" + std::to_string(saved->number)
                                 : std::string("nothing in it can be restored for this map: begins with the first map");
  if (aside) {
    opened.warnings.push_back("map store set aside as " + aside->string() + ": " + reason.what() + "; " + from);
    try {
      opened.store.store = brought_forward(file, first, saved);
      return;
    } catch (const StoreError& error) {
      opened.store.why_not = error.what();
    }
  } else {
    opened.warnings.push_back(std::string("map store cannot be written: ") + reason.what() + "; " + from);
    opened.store.why_not = reason.what();
  }
  opened.store.open = [file, saved, first = std::make_shared<const OccupancyGrid>(first)] {
    return brought_forward(file, *first, saved);
  };
}

}  // namespace

std::string words_of_others(const MapStore& store) {
  const std::uint32_t others = store.newest() == 0 ? store.revisions_of_others() : 0;
  if (others == 0) return "";
  return "holds " + std::to_string(others) + (others == 1 ? " revision" : " revisions") +
         " of another first map and none of this one: begins with the first map";
}

OpenedStore open_store(const fs::path& name, const OccupancyGrid& first) {
  (void)judged_store_place(name);
  // What is locked, opened and set aside is the database, and no link to it. Without knowing whether another program
  // has it, it is not touched.
  const fs::path file = or_start_error([&] { return file_behind(name); });
  OpenedStore opened;
  opened.store.to_lock = file;
  opened.store.lock = or_start_error([&] { return lock_of_file(file); });
  try {
    take(opened, MapStore{file, first}, first);
  } catch (const StoreError& error) {
    go_on_without(opened, file, first, error);
  }
  return opened;
}

}  // namespace deltamap::daemon
