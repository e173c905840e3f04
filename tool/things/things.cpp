// SPDX-License-Identifier: Apache-2.0
// `deltamap things STORE|DIR`: what has come, gone and moved in a map, from the revisions that a store or a run's
// folder holds. The same revisions told the daemon the same.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>

#include "core/files/grid_file.hpp"
#include "core/utc_text.hpp"
#include "daemon/maps/store_opening.hpp"
#include "daemon/maps/stored_things.hpp"
#include "daemon/outputs/thing_note.hpp"
#include "tool/ctl/things_table.hpp"
#include "tool/subcommands.hpp"

namespace deltamap::tool {
namespace {

using mapping::store::MapStore;
using mapping::things::ThingEvent;
using mapping::things::Things;

struct ThingsOptions {
  std::string source;
  std::string map;
  bool as_json = false;
  bool events = false;
  bool seen_only = false;
};

std::filesystem::path store_in(const std::string& source) {
  const std::filesystem::path place{source};
  if (!std::filesystem::is_directory(place)) return place;
  const auto store = place / "map_store.sqlite";
  if (!std::filesystem::exists(store)) {
    throw std::runtime_error(source + ": holds no map_store.sqlite: give a map store, or the folder of a run (--out)");
  }
  return store;
}

/// Of the first map that is given, else of that which was used last.
MapStore opened(const ThingsOptions& options) {
  const std::filesystem::path file = store_in(options.source);
  std::error_code error;
  if (std::filesystem::file_size(file, error) == 0 && !error)
    throw std::runtime_error(file.string() + ": is empty: no map store");
  MapStore store = options.map.empty() ? MapStore::to_read(file) : MapStore::in_memory(file, read_grid(options.map));
  if (!store.damage().empty()) std::cerr << "deltamap: " << store.damage() << "; the file is left as it is\n";
  if (const std::string others = options.map.empty() ? "" : daemon::words_of_others(store); !others.empty()) {
    throw std::runtime_error(file.string() + ": holds no revision of " + options.map +
                             ": it belongs to another first map");
  }
  return store;
}

void print_event(const ThingEvent& event) {
  std::printf("%s  M%-6u %s thing %u: %s\n", utc_text(event.time).c_str(), event.revision, event.is_new ? "+" : " ",
              event.thing.id, words_of(event.thing).c_str());
}

void tell_things(const ThingsOptions& options) {
  const MapStore store = opened(options);
  const auto tell_event = [&](const ThingEvent& event) {
    if (!options.events) return;
    if (options.as_json) std::cout << daemon::json_line(event);
    if (!options.as_json) print_event(event);
  };
  const Things things = daemon::things_of(store, {.assumes_sides = !options.seen_only}, tell_event);
  if (options.events) return;
  const std::string list = daemon::json_of({things.all(), things.corrections(), things.forgotten()});
  std::cout << (options.as_json ? list + "\n" : things_table(list));
}

}  // namespace

void add_things(CLI::App& app) {
  auto options = std::make_shared<ThingsOptions>();
  CLI::App* command = app.add_subcommand("things", "what has come, gone and moved, from the revisions of a map");
  command->add_option("SOURCE", options->source, "map store (SQLite), or the folder of a run (--out)")->required();
  command->add_option("--map", options->map, "the first map that the revisions must be of; else that used last");
  command->add_flag("--events", options->events, "each event in its order, as in things.jsonl");
  command->add_flag("--seen-only", options->seen_only, "without what is assumed of sides that nobody has seen");
  command->add_flag("--json", options->as_json, "as JSON: all things, or with --events a line an event");
  command->callback([options] { tell_things(*options); });
}

}  // namespace deltamap::tool
