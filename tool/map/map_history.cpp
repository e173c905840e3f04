// SPDX-License-Identifier: Apache-2.0
// `deltamap map history STORE …`: what the map store remembers: list it, take out a revision, compare two, go back to
// one, draw what one has changed, take one back and keep what came later, name one so that it stays.
#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/counted.hpp"
#include "core/files/file_lock.hpp"
#include "core/files/grid_file.hpp"
#include "core/files/replace_file.hpp"
#include "daemon/maps/png_bytes.hpp"
#include "daemon/maps/stored_things.hpp"
#include "mapping/registration/acceptance.hpp"
#include "mapping/store/map_store.hpp"
#include "mapping/things/assumed.hpp"
#include "tool/output_file.hpp"
#include "tool/picture/scene.hpp"
#include "tool/subcommands.hpp"

namespace deltamap::tool {
namespace {

using mapping::store::MapStore;
using mapping::store::StoredRevision;

struct HistoryOptions {
  std::string store;
  std::uint32_t number = 0;
  std::uint32_t other = 0;
  std::string out;
  std::string name;
  bool json = false;
  bool cells = false;
  bool assumed = false;
};

std::string utc(Timestamp time) {
  if (unix_ns(time) == 0) return "-";
  const std::time_t seconds =
      std::chrono::system_clock::to_time_t(std::chrono::time_point_cast<std::chrono::system_clock::duration>(time));
  std::tm calendar{};
  gmtime_r(&seconds, &calendar);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%d %H:%M:%S", &calendar);
  return text;
}

nlohmann::json box_as_json(const CellBox& box) {
  if (box.empty()) return nullptr;
  return {box.first.column, box.first.row, box.last.column - 1, box.last.row - 1};
}

nlohmann::json covariance_as_json(const std::optional<PoseCovariance>& covariance) {
  if (!covariance) return nullptr;
  const auto& c = *covariance;
  return {{"xx_m2", c(0, 0)}, {"xy_m2", c(0, 1)},    {"xh_m_rad", c(0, 2)},
          {"yy_m2", c(1, 1)}, {"yh_m_rad", c(1, 2)}, {"hh_rad2", c(2, 2)}};
}

const char* name_of(CellState state) {
  switch (state) {
    case CellState::kFree:
      return "free";
    case CellState::kOccupied:
      return "occupied";
    case CellState::kUnknown:
      return "unknown";
  }
  return "?";
}

/// Of a damaged store, what can be had.
MapStore read_store(const HistoryOptions& options) {
  MapStore store = MapStore::to_read(options.store);
  if (!store.damage().empty()) std::cerr << "deltamap: " << store.damage() << "; the file is left as it is\n";
  return store;
}

Timestamp store_time(const MapStore& store, std::uint32_t number) {
  for (const StoredRevision& revision : store.history()) {
    if (!revision.refused && revision.number == number) return revision.time;
  }
  return {};
}

void list(const HistoryOptions& options) {
  const MapStore store = read_store(options);
  if (!options.json)
    std::printf("%6s  %-19s  %5s  %8s  %7s  %7s  %s\n", "k", "time (UTC)", "phase", "occupied", "freed", "accept.",
                "cause");
  for (const StoredRevision& revision : store.history()) {
    if (options.json) {
      nlohmann::json line{{"number", revision.number},
                          {"refused", revision.refused},
                          {"time_ns", unix_ns(revision.time)},
                          {"phase", revision.note.phase},
                          {"acceptance", revision.note.acceptance},
                          {"cause", revision.note.cause},
                          {"covariance", covariance_as_json(revision.note.covariance)},
                          {"occupied", revision.occupied},
                          {"freed", revision.freed},
                          {"unknown", revision.unknown},
                          {"box", box_as_json(revision.box)}};
      if (!revision.name.empty()) line["name"] = revision.name;
      std::cout << line.dump() << '\n';
      continue;
    }
    const std::string number = revision.refused ? "-" : std::to_string(revision.number);
    const std::string name = revision.name.empty() ? "" : "  \"" + revision.name + "\"";
    std::printf("%6s  %-19s  %5u  %8u  %7u  %7.3f  %s%s%s\n", number.c_str(), utc(revision.time).c_str(),
                revision.note.phase, revision.occupied, revision.freed, revision.note.acceptance,
                revision.refused ? "refused: " : "", revision.note.cause.c_str(), name.c_str());
  }
}

/// The map with the sides and insides of things that are assumed: shade 128, which map_server reads as unknown.
void write_with_assumed(const MapStore& store, const HistoryOptions& options) {
  constexpr auto kAssumedShade = static_cast<char>(128);
  const OccupancyGrid map = store.grid(options.number);
  const auto things = daemon::things_of(store, {}, {}, {}, options.number).all();
  std::string picture = pgm_of(map);
  const auto width = static_cast<std::size_t>(map.width());
  for (const Cell cell : mapping::things::assumed_cells(things, map)) {
    const auto from_below = static_cast<std::size_t>(cell.row + 1) * width;  // the picture begins at the top
    picture[picture.size() - from_below + static_cast<std::size_t>(cell.column)] = kAssumedShade;
  }
  const std::filesystem::path image = std::filesystem::path(options.out).replace_extension(".pgm");
  replace_file(image, picture);
  replace_file(options.out, yaml_of(map, image.filename().string()));
}

void write_revision(const HistoryOptions& options) {
  require_output_beside(options.out, options.store);
  require_output_beside(std::filesystem::path(options.out).replace_extension(".pgm"), options.store);
  if (options.assumed) {
    write_with_assumed(read_store(options), options);
  } else {
    write_grid(read_store(options).grid(options.number), options.out);
  }
  if (options.json) std::cout << nlohmann::json{{"number", options.number}, {"map", options.out}}.dump() << '\n';
}

nlohmann::json changes_as_json(const std::vector<CellChange>& changes) {
  nlohmann::json list = nlohmann::json::array();
  for (const CellChange& change : changes) {
    list.push_back({change.cell.column, change.cell.row, name_of(change.before), name_of(change.after)});
  }
  return list;
}

void print_changes(const std::vector<CellChange>& changes) {
  for (const CellChange& change : changes) {
    std::printf("%d %d %s %s\n", change.cell.column, change.cell.row, name_of(change.before), name_of(change.after));
  }
}

void compare(const HistoryOptions& options) {
  const MapStore store = read_store(options);
  const OccupancyGrid before = store.grid(options.number);
  const OccupancyGrid after = store.grid(options.other);
  const auto changes = changes_between(before, after);
  std::size_t became[3] = {};
  for (const CellChange& change : changes) ++became[static_cast<std::size_t>(change.after)];
  const double acceptance = mapping::registration::acceptance(before, after).value();
  nlohmann::json result{{"from", options.number},   {"to", options.other},
                        {"cells", changes.size()},  {"freed", became[0]},
                        {"occupied", became[1]},    {"unknown", became[2]},
                        {"acceptance", acceptance}, {"box", box_as_json(bounding_box(changes))}};
  if (options.json) {
    if (options.cells) result["changes"] = changes_as_json(changes);
    std::cout << result.dump() << '\n';
  } else {
    std::printf("%s: %zu became occupied, %zu free, %zu unknown; acceptance %.4f\n",
                counted(changes.size(), "cell differs", "cells differ").c_str(), became[1], became[0], became[2],
                acceptance);
    if (options.cells) print_changes(changes);
  }
}

/// Left the place before Δ K, right after it.
void draw_delta(const HistoryOptions& options) {
  constexpr double kAround_m = 3.0;
  require_output_beside(options.out, options.store);
  const MapStore store = read_store(options);
  if (options.number == 0) throw std::runtime_error("revision 0 is the first map: it has changed nothing");
  const std::vector<CellChange> changes = store.changes(options.number);
  const OccupancyGrid after = store.grid(options.number);
  std::vector<CellChange> back = changes;
  for (CellChange& change : back) std::swap(change.before, change.after);
  const OccupancyGrid before = patched(after, back);
  const int around = static_cast<int>(kAround_m / after.resolution_m());
  picture::Scene scene{.map = before};
  if (!changes.empty()) scene.shown = grown(bounding_box(changes), around, after.geometry());
  scene.title = "before";
  const picture::Raster left = drawn(scene);
  picture::Scene changed{.map = after, .before = &before};
  changed.shown = scene.shown;
  changed.title = "M" + std::to_string(options.number) + ", " + utc(store_time(store, options.number)) + " UTC";
  const picture::Raster both = side_by_side(left, drawn(changed));
  daemon::write_bytes(daemon::png_of(both.width, both.height, both.rgb), options.out);
  if (options.json) {
    std::cout << nlohmann::json{{"number", options.number}, {"picture", options.out}, {"cells", changes.size()}}.dump()
              << '\n';
  }
}

void roll_back(const HistoryOptions& options) {
  const auto lock = lock_of_file(options.store);  // a daemon that writes there would lose its place
  MapStore store{options.store};
  const std::uint32_t number = store.roll_back(options.number, std::chrono::system_clock::now());
  if (options.json) {
    std::cout << nlohmann::json{{"number", number}, {"same_as", options.number}}.dump() << '\n';
  } else {
    std::printf("revision %u is revision %u again\n", number, options.number);
  }
}

void undo(const HistoryOptions& options) {
  const auto lock = lock_of_file(options.store);
  MapStore store{options.store};
  const std::uint32_t number = store.undo(options.number, std::chrono::system_clock::now());
  const std::size_t cells = store.changes(number).size();
  if (options.json) {
    std::cout << nlohmann::json{{"number", number}, {"undone", options.number}, {"cells", cells}}.dump() << '\n';
  } else {
    std::printf("revision %u takes revision %u back: %s\n", number, options.number, counted(cells, "cell").c_str());
  }
}

/// Without the store's lock: a daemon that writes there does not lose its place.
void set_name(const HistoryOptions& options) {
  MapStore{options.store}.set_name(options.number, options.name);
  if (options.json) {
    std::cout << nlohmann::json{{"number", options.number}, {"name", options.name}}.dump() << '\n';
  } else if (options.name.empty()) {
    std::printf("revision %u has no name\n", options.number);
  } else {
    std::printf("revision %u stays, as \"%s\"\n", options.number, options.name.c_str());
  }
}

/// The subcommands that leave the store as it is.
void add_what_reads(CLI::App& history, const std::shared_ptr<HistoryOptions>& options) {
  CLI::App* lister = history.add_subcommand("list", "every revision and refusal, oldest first");
  lister->fallthrough()->callback([options] { list(*options); });

  CLI::App* exporter = history.add_subcommand("export", "write revision K as a map");
  exporter->add_option("K", options->number)->required();
  exporter->add_option("OUT", options->out, "map_server YAML to write")->required();
  exporter->add_flag("--assumed", options->assumed,
                     "sides and insides of things that are assumed in shade 128: unknown");
  exporter->fallthrough()->callback([options] { write_revision(*options); });

  CLI::App* differ = history.add_subcommand("diff", "what changed from revision J to K");
  differ->add_option("J", options->number)->required();
  differ->add_option("K", options->other)->required();
  differ->add_flag("--cells", options->cells, "each cell: column, row, before, after");
  differ->fallthrough()->callback([options] { compare(*options); });

  CLI::App* painter = history.add_subcommand("picture", "draw what revision K has changed: before and after");
  painter->add_option("K", options->number)->required();
  painter->add_option("OUT", options->out, "PNG to write")->required();
  painter->fallthrough()->callback([options] { draw_delta(*options); });
}

void add_what_writes(CLI::App& history, const std::shared_ptr<HistoryOptions>& options) {
  CLI::App* roller = history.add_subcommand("rollback", "make revision K the newest again; nothing is lost");
  roller->add_option("K", options->number)->required();
  roller->fallthrough()->callback([options] { roll_back(*options); });

  CLI::App* undoer = history.add_subcommand("undo", "take revision K back and keep what came later; nothing is lost");
  undoer->add_option("K", options->number)->required();
  undoer->fallthrough()->callback([options] { undo(*options); });

  CLI::App* namer = history.add_subcommand("name", "revision K stays, whatever map.retention says, and is listed so");
  namer->add_option("K", options->number)->required();
  namer->add_option("NAME", options->name, "one line; \"\": takes the name away")->required();
  namer->fallthrough()->callback([options] { set_name(*options); });
}

}  // namespace

void add_map_history(CLI::App& map) {
  auto options = std::make_shared<HistoryOptions>();
  CLI::App* history =
      map.add_subcommand("history", "the revisions of a map: list, export, diff, picture, rollback, undo, name");
  history->require_subcommand(1);
  history->fallthrough();
  history->add_option("STORE", options->store, "map store (SQLite)")->required();
  history->add_flag("--json", options->json, "one JSON object a line");
  add_what_reads(*history, options);
  add_what_writes(*history, options);
}

}  // namespace deltamap::tool
