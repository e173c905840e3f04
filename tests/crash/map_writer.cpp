// SPDX-License-Identifier: Apache-2.0
// Keeps maps as the daemon's map thread does, through the daemon's own outputs, as fast as it can, and says what it
// believes to be safe: for whoever kills it, or lets its disk fail. Every map tells its own serial number and follows
// from it, so that a map that is torn, or is of another serial, shows.
// usage: map_writer write FOLDER COUNT | map_writer verify FOLDER
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>

#include "core/files/grid_file.hpp"
#include "core/grid/grid_patch.hpp"
#include "daemon/kept/memory_keeper.hpp"
#include "daemon/maps/map_outputs.hpp"
#include "daemon/maps/newest_map.hpp"
#include "daemon/maps/store_opening.hpp"
#include "daemon/settings/memory_places.hpp"
#include "mapping/store/map_store.hpp"

namespace deltamap::daemon {
namespace {

namespace fs = std::filesystem;

const GridGeometry kGeometry{200, 120, 0.05, {-1.0, -2.0}};
constexpr int kSerialBits = 32;  // in the lowest row
constexpr int kBoxes = 20;       // that stand elsewhere every few serials
constexpr mapping::store::Retention kRetention{.revisions = 20, .days = 0.0};

/// Differs from that of the next serial in a few cells.
OccupancyGrid map_of(std::uint32_t serial) {
  OccupancyGrid map{kGeometry, CellState::kFree};
  for (int bit = 0; bit < kSerialBits; ++bit) {
    if ((serial >> bit & 1) != 0) map.set({bit, 0}, CellState::kOccupied);
  }
  for (int box = 0; box < kBoxes; ++box) {
    const auto times = static_cast<int>(serial / static_cast<std::uint32_t>(box + 1));
    const Cell corner{10 * box + times % 5, 2 + times * 7 % (kGeometry.height - 10)};
    for (int cell = 0; cell < 16; ++cell) {
      map.set({corner.column + cell % 4, corner.row + cell / 4},
              box % 2 == 0 ? CellState::kOccupied : CellState::kUnknown);
    }
  }
  return map;
}

/// Nothing where the map is torn.
std::optional<std::uint32_t> serial_of(const OccupancyGrid& map) {
  std::uint32_t serial = 0;
  for (int bit = 0; bit < kSerialBits; ++bit) {
    if (map[{bit, 0}] == CellState::kOccupied) serial |= std::uint32_t{1} << bit;
  }
  return map == map_of(serial) ? std::optional{serial} : std::nullopt;
}

struct Places {
  explicit Places(const fs::path& folder)
      : store{folder / "store.sqlite"}, newest{folder / "map.yaml"}, out{folder / "out"} {}
  fs::path store;
  fs::path newest;
  fs::path out;
};

/// As the daemon opens it.
OpenedStore opened(const Places& places) {
  OpenedStore store = open_store(places.store, map_of(0));
  for (const std::string& warning : store.warnings) std::cout << "warning " << warning << std::endl;
  store.store.retention = kRetention;
  return store;
}

MapStep::Result next_result(std::uint32_t number, std::uint32_t serial, Timestamp time) {
  MapStep::Result result;
  result.revision = MapRevision{.number = number,
                                .time = time,
                                .map = std::make_shared<const OccupancyGrid>(map_of(serial)),
                                .changes = changes_between(map_of(serial - 1), map_of(serial)),
                                .field_patch = {}};
  result.note.time = time;
  result.note.revision = number;
  return result;
}

bool is_written(const OutputBoard& board, const std::string& name) {
  for (const OutputStatus& output : board.all()) {
    if (output.name == name) return output.written;
  }
  return false;
}

/// "safe store SERIAL": what is on disk by the word of the outputs.
void tell_safe(const MapOutputs& outputs, const OutputBoard& board, std::uint32_t serial) {
  if (outputs.why_behind().empty()) std::cout << "safe store " << serial << std::endl;
  if (is_written(board, "newest")) std::cout << "safe newest " << serial << std::endl;
}

/// Kept pose: the text of one serial, whole or not at all.
KeptPose pose_of(std::uint32_t serial) {
  KeptPose pose;
  pose.map_from_robot = {0.001 * serial, 1.0, 0.5};
  pose.revision = serial;
  pose.is_sure = true;
  return pose;
}

int write(const fs::path& folder, std::uint32_t count) {
  const Places places{folder};
  fs::create_directories(places.out);
  const auto warn = [](const std::string& line) { std::cout << "warning " << line << std::endl; };
  const auto lock =
      newest_map_lock({.file = "none.yaml", .store = places.store, .retention = {}, .newest = places.newest});
  OpenedStore store = opened(places);
  const auto first = serial_of(*store.start.map);
  if (!first) throw std::runtime_error("begins on a map that is torn");
  std::cout << "began " << *first << std::endl;
  OutputBoard board;
  Timestamp now = std::chrono::system_clock::now();
  std::uint32_t number = store.start.revision;
  MapOutputs outputs{{.out = places.out,
                      .store_file = places.store,
                      .newest_file = places.newest,
                      .store = std::move(store.store),
                      .start = store.start,
                      .method = "evidence"},
                     board,
                     warn,
                     now};
  MemoryKeeper memory{memory_places(places.store), board, warn};
  tell_safe(outputs, board, *first);
  for (std::uint32_t serial = *first + 1; serial <= *first + count; ++serial) {
    now += std::chrono::seconds(1);
    outputs.save(next_result(++number, serial, now), now);
    tell_safe(outputs, board, serial);
    memory.keep(pose_of(serial), now);
    memory.retry(now);
    outputs.retry(now);
  }
  outputs.close(now + std::chrono::seconds(10));
  memory.close(now + std::chrono::seconds(10));
  std::cout << "ended" << std::endl;
  return 0;
}

/// Of a map that other programs read; nothing where there is none. Throws where it is torn.
std::optional<std::uint32_t> serial_in(const fs::path& yaml) {
  if (!fs::exists(yaml)) return std::nullopt;
  const auto serial = serial_of(read_grid(yaml));
  if (!serial) throw std::runtime_error(yaml.string() + ": is torn");
  return serial;
}

/// Every revision that the store tells of; answers how many.
int count_sound(const mapping::store::MapStore& store) {
  int sound = 0;
  std::optional<std::uint32_t> before;
  for (const mapping::store::StoredRevision& revision : store.history()) {
    if (revision.refused) continue;
    const auto serial = serial_of(store.grid(revision.number));
    if (!serial) throw std::runtime_error("revision " + std::to_string(revision.number) + " is torn");
    if (before && *serial <= *before)
      throw std::runtime_error("revision " + std::to_string(revision.number) + " is old");
    before = serial;
    ++sound;
  }
  return sound;
}

int verify(const fs::path& folder) {
  const Places places{folder};
  const OpenedStore store = opened(places);
  if (!store.store.store) throw std::runtime_error("cannot be opened: " + store.store.why_not);
  const auto newest = serial_of(*store.start.map);
  if (!newest) throw std::runtime_error("the newest revision is torn");
  std::cout << "store " << *newest << " revisions " << count_sound(*store.store.store) << std::endl;
  for (const auto& [name, yaml] : {std::pair{"newest", places.newest}, std::pair{"out", places.out / "map.yaml"}}) {
    if (const auto serial = serial_in(yaml)) std::cout << name << ' ' << *serial << std::endl;
  }
  const KeptPoseAnswer pose = read_kept_pose(memory_places(places.store).pose, 0);
  if (!pose.why_not.empty()) throw std::runtime_error("kept pose: " + pose.why_not);
  return 0;
}

}  // namespace
}  // namespace deltamap::daemon

int main(int argc, char** argv) {
  const std::string job = argc > 2 ? argv[1] : "";
  try {
    if (job == "verify") return deltamap::daemon::verify(argv[2]);
    if (job == "write" && argc > 3)
      return deltamap::daemon::write(argv[2], static_cast<std::uint32_t>(std::atoi(argv[3])));
  } catch (const std::exception& error) {
    std::cout << "error " << error.what() << std::endl;
    return 1;
  }
  std::cerr << "usage: map_writer write FOLDER COUNT | map_writer verify FOLDER\n";
  return 2;
}
