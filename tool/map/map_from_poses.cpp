// SPDX-License-Identifier: Apache-2.0
#include "tool/map/map_from_poses.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <vector>

#include "core/counted.hpp"
#include "core/files/grid_file.hpp"
#include "core/grid/grid_ray.hpp"
#include "drivers/carmen/carmen_log.hpp"
#include "drivers/carmen/carmen_survey.hpp"
#include "drivers/carmen/carmen_words.hpp"
#include "tool/import_carmen.hpp"
#include "tool/progress.hpp"
#include "tool/subcommands.hpp"

namespace deltamap::tool {
namespace {

namespace fs = std::filesystem;

constexpr int kMaxSide = 32767;                  // cells: what a map file may hold
constexpr std::int64_t kMaxCells = 100'000'000;  // 800 MB of counters

struct Bounds {
  Point2 low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  Point2 high{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  void include(const Point2& point) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
};

/// Calls visit(laser, end) in the map's frame for every valid range of the log; answers the number of scans.
template <typename Visit>
std::size_t for_each_beam(const fs::path& log, const drivers::carmen::CarmenSurvey& survey, const std::string& doing,
                          Visit&& visit) {
  drivers::carmen::CarmenLog lines{log, survey.clock, survey.headings};
  Progress progress{doing + " " + log.filename().string(), lines.size_bytes()};
  std::size_t scans = 0;
  while (const auto record = lines.next()) {
    progress.show(lines.read_bytes());
    const auto* scan = std::get_if<drivers::carmen::CarmenScan>(&*record);
    if (scan == nullptr || !scan->poses) continue;
    ++scans;
    const drivers::carmen::CarmenWords words{*scan, survey};
    const Pose2& map_from_laser = scan->poses->odom_from_laser;
    for (std::size_t i = 0; i < scan->ranges_m.size(); ++i) {
      const double range_m = scan->ranges_m[i];
      if (!words.is_range(range_m)) continue;
      const double bearing = scan->first_bearing_rad + static_cast<double>(i) * scan->bearing_step_rad;
      visit(map_from_laser.position(),
            map_from_laser * Point2{range_m * std::cos(bearing), range_m * std::sin(bearing)});
    }
  }
  return scans;
}

/// Borders of cells lie on multiples of the resolution, so that maps of the same frame fit onto each other.
GridGeometry geometry_around(const Bounds& bounds, const MapFromPosesParams& params, const fs::path& log) {
  const auto cells_below = [&](double metres) { return std::floor((metres - params.margin_m) / params.resolution_m); };
  const auto cells_above = [&](double metres) { return std::ceil((metres + params.margin_m) / params.resolution_m); };
  const Point2 first{cells_below(bounds.low.x()), cells_below(bounds.low.y())};
  const double width = cells_above(bounds.high.x()) - first.x() + 1.0;
  const double height = cells_above(bounds.high.y()) - first.y() + 1.0;
  if (width > kMaxSide || height > kMaxSide || width * height > static_cast<double>(kMaxCells)) {
    throw std::runtime_error(log.string() + ": the map would need " + std::to_string(static_cast<std::int64_t>(width)) +
                             " x " + std::to_string(static_cast<std::int64_t>(height)) +
                             " cells; take a coarser --resolution, or the poses are wrong");
  }
  return {static_cast<int>(width), static_cast<int>(height), params.resolution_m, first * params.resolution_m};
}

struct CellCount {
  std::uint32_t hits = 0;
  std::uint32_t passes = 0;
};

OccupancyGrid grid_of(const GridGeometry& geometry, const std::vector<CellCount>& counts,
                      const MapFromPosesParams& params) {
  OccupancyGrid grid{geometry};
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const double beams = static_cast<double>(counts[i].hits) + counts[i].passes;
    if (beams == 0.0) continue;
    const bool occupied = counts[i].hits >= params.least_hits && counts[i].hits >= params.occupied_ratio * beams;
    if (!occupied && counts[i].passes == 0) continue;  // a single hit: neither wall nor way
    grid.set(geometry.cell_of(i), occupied ? CellState::kOccupied : CellState::kFree);
  }
  return grid;
}

struct FromPosesOptions {
  std::string log;
  std::string yaml;
  MapFromPosesParams params;
  bool json = false;
};

std::vector<std::string> notes_of(const MapFromPoses& made) {
  std::vector<std::string> notes = made.survey.notes;
  notes.insert(notes.end(), made.survey.map_notes.begin(), made.survey.map_notes.end());
  if (made.survey.doubled_scans > 0) notes.push_back(drivers::carmen::doubled_line(made.survey));
  return notes;
}

std::string as_json(const MapFromPoses& made, const std::string& yaml) {
  const auto& no_return_m = made.survey.no_return_m;
  return nlohmann::ordered_json{{"map", yaml},
                                {"scans", made.scans},
                                {"beams", made.beams},
                                {"width", made.grid.width()},
                                {"height", made.grid.height()},
                                {"resolution_m", made.grid.resolution_m()},
                                {"occupied_cells", count_of(made.grid, CellState::kOccupied)},
                                {"free_cells", count_of(made.grid, CellState::kFree)},
                                {"no_return_m", no_return_m ? nlohmann::ordered_json(*no_return_m) : nullptr},
                                {"no_return_share", made.survey.no_return_share},
                                {"notes", notes_of(made)}}
      .dump(2);
}

void print(const MapFromPoses& made, const std::string& yaml) {
  std::cout << yaml << ": " << made.grid.width() << " x " << made.grid.height() << " cells of "
            << made.grid.resolution_m() << " m from " << counted(made.scans, "scan") << ", "
            << count_of(made.grid, CellState::kOccupied) << " occupied, " << count_of(made.grid, CellState::kFree)
            << " free\n";
  if (const std::string line = drivers::carmen::no_return_line(made.survey); !line.empty()) std::cout << line << '\n';
  for (const std::string& note : notes_of(made)) std::cout << note << '\n';
}

void run_from_poses(const FromPosesOptions& options) {
  const MapFromPoses made = map_from_poses(options.log, options.params);
  if (made.survey.cut) std::cerr << "deltamap: warning: " << *made.survey.cut << '\n';
  write_grid(made.grid, options.yaml);
  if (options.json) {
    std::cout << as_json(made, options.yaml) << '\n';
  } else {
    print(made, options.yaml);
  }
}

}  // namespace

MapFromPoses map_from_poses(const fs::path& log, const MapFromPosesParams& params) {
  MapFromPoses made;
  made.survey = shown_survey_of(log, params.no_return_m);
  const drivers::carmen::CarmenSurvey& survey = made.survey;
  if (!survey.scans_carry_poses) throw std::runtime_error(log.string() + ": no scan carries a laser pose");
  Bounds bounds;
  made.scans = for_each_beam(log, survey, "measuring", [&](const Point2& laser, const Point2& end) {
    bounds.include(laser);
    bounds.include(end);
    ++made.beams;
  });
  if (made.beams == 0) throw std::runtime_error(log.string() + ": no scan has a valid range");
  const GridGeometry geometry = geometry_around(bounds, params, log);
  std::vector<CellCount> counts(geometry.cell_count());
  (void)for_each_beam(log, survey, "mapping", [&](const Point2& laser, const Point2& end) {
    const Cell last = geometry.cell_at(end);
    walk_ray(geometry, laser, end, [&](Cell cell, double) {
      CellCount& count = counts[geometry.index_of(cell)];
      ++(cell == last ? count.hits : count.passes);
      return true;
    });
  });
  made.grid = grid_of(geometry, counts, params);
  return made;
}

void add_map_from_poses(CLI::App& map) {
  auto options = std::make_shared<FromPosesOptions>();
  CLI::App& command = *map.add_subcommand("from-poses", "grid from a CARMEN log whose laser poses are known");
  command.add_option("LOG", options->log, "CARMEN log with FLASER or ROBOTLASER1 lines")->required();
  command.add_option("OUT", options->yaml, "map to write (.yaml, the .pgm beside it)")
      ->required()
      ->check([](const std::string& file) {
        const auto ending = fs::path(file).extension();
        return ending == ".yaml" || ending == ".yml" ? "" : "must end in .yaml";
      });
  command.add_option("--resolution", options->params.resolution_m, "side of a cell, m")
      ->check(CLI::Range(0.001, 10.0))
      ->capture_default_str();
  command.add_option("--no-return", options->params.no_return_m, drivers::carmen::kNoReturnHelp)
      ->check(CLI::NonNegativeNumber);
  command.add_flag("--json", options->json, "print the result as JSON");
  command.callback([options] { run_from_poses(*options); });
}

}  // namespace deltamap::tool
