// SPDX-License-Identifier: Apache-2.0
#include "experiments/merge/merge_places.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <stdexcept>

#include "core/files/grid_file.hpp"
#include "core/files/scratch_folder.hpp"
#include "core/geometry/angle.hpp"
#include "experiments/merge/merge_layouts.hpp"
#include "mapping/registration/transformed_grid.hpp"

namespace deltamap::experiments {
namespace {

namespace fs = std::filesystem;

constexpr double kFirstShare = 0.75;  // the map's columns end here …
constexpr double kOtherShare = 0.25;  // … and the other world's begin here
constexpr double kMostShift_cells = 10.0;

std::string quoted(const fs::path& path) {
  if (path.string().find('\'') != std::string::npos) throw std::runtime_error(path.string() + ": a quote in its name");
  return "'" + path.string() + "'";
}

std::optional<OccupancyGrid> recorded_map(const fs::path& maps, const std::string& name) {
  const fs::path yaml = maps / (name + ".yaml");
  const fs::path packed = maps / (name + ".pgm.xz");
  if (!fs::exists(yaml)) return std::nullopt;
  if (fs::exists(maps / (name + ".pgm"))) return read_grid(yaml);
  if (!fs::exists(packed)) return std::nullopt;
  const ScratchFolder scratch;
  fs::copy_file(yaml, scratch.path() / yaml.filename());
  const std::string command = "xz -dc " + quoted(packed) + " > " + quoted(scratch.path() / (name + ".pgm"));
  if (std::system(command.c_str()) != 0) throw std::runtime_error(packed.string() + ": xz cannot unpack it");
  return read_grid(scratch.path() / yaml.filename());
}

MergePlace place_of(const std::string& name, const OccupancyGrid& world, const OccupancyGrid& other_world) {
  // Where a cell is an even number of the world's, its centre would fall between two of them: half of one on.
  const double part = kMergeResolution_m / world.resolution_m();
  const bool between = std::lround(part) % 2 == 0;
  const double half_m = between ? 0.5 * world.resolution_m() : 0.0;
  const Pose2 map_from_other{half_m, half_m, 0.0};
  OccupancyGrid map = mapping::registration::moved_grid(mapping::registration::part_of(world, 0.0, kFirstShare),
                                                        map_from_other, kMergeResolution_m);
  mapping::merge::OverlayMap overlay{map};
  return {name, std::move(map), mapping::registration::part_of(other_world, kOtherShare, 1.0), map_from_other,
          std::move(overlay)};
}

}  // namespace

MergePlace drawn_place(const std::string& layout, std::uint64_t seed) {
  for (const MergeLayout& known : merge_layouts()) {
    if (known.name != layout) continue;
    const OccupancyGrid world = known.drawn(seed);
    return place_of(layout, world, world);
  }
  throw std::runtime_error("there is no layout '" + layout + "'");
}

std::vector<std::string> recorded_places() { return {"freiburg", "gdc2"}; }

std::optional<MergePlace> recorded_place(const std::string& name, const fs::path& data) {
  const bool is_pair = name == "gdc2";
  const auto world = recorded_map(data / "maps", is_pair ? "gdc2_bare" : name);
  const auto other = is_pair ? recorded_map(data / "maps", "gdc2_furniture") : world;
  if (!world || !other) return std::nullopt;
  return place_of(name, *world, *other);
}

LocalMap turned_local(const MergePlace& place, bool whole, Random& random) {
  double x_cells = random.uniform(-kMostShift_cells, kMostShift_cells);
  double y_cells = random.uniform(-kMostShift_cells, kMostShift_cells);
  double turn_deg = random.uniform(-180.0, 180.0);
  if (whole) x_cells = std::round(x_cells), y_cells = std::round(y_cells), turn_deg = std::round(turn_deg);
  const Pose2 local_from_other{kMergeResolution_m * x_cells, kMergeResolution_m * y_cells,
                               wrapped_angle(radians(turn_deg))};
  return {local_from_other, mapping::registration::moved_grid(place.other, local_from_other, kMergeResolution_m)};
}

MergeMeasure measured(const MergePlace& place, const LocalMap& local, const Pose2& map_from_local) {
  const mapping::merge::LocalCells cells{local.grid};
  const Pose2 truth = place.map_from_other * inverse(local.local_from_other);
  const auto acceptance_at = [&](const Pose2& pose) {
    return place.overlay.score(cells, mapping::merge::cell_motion(pose, place.map.geometry(), cells)).acceptance();
  };
  MergeMeasure measure;
  measure.acceptance = acceptance_at(map_from_local);
  measure.true_acceptance = acceptance_at(truth);
  measure.agreement = mapping::registration::surface_agreement(place.map, local.grid, map_from_local);
  measure.off_cells =
      (map_from_local * cells.middle_in_local() - truth * cells.middle_in_local()).norm() / kMergeResolution_m;
  measure.turn_deg = std::abs(degrees(turn_between(truth.theta, map_from_local.theta)));
  return measure;
}

double cpu_ms(const std::function<void()>& work) {
  const auto now_ms = [] {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
  };
  const double began_ms = now_ms();
  work();
  return now_ms() - began_ms;
}

}  // namespace deltamap::experiments
