// SPDX-License-Identifier: Apache-2.0
// `deltamap map merge A B`: finds where B lies on A and writes A with B's known cells laid over it. A merge that is
// refused is told with its figures and writes nothing.
#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/files/grid_file.hpp"
#include "mapping/merge/map_merge.hpp"
#include "mapping/registration/acceptance.hpp"
#include "mapping/registration/transformed_grid.hpp"
#include "surveying/grid_registration/global_merge.hpp"
#include "surveying/grid_registration/prior_merge.hpp"
#include "tool/subcommands.hpp"
#include "tool/told_grid.hpp"

namespace deltamap::tool {
namespace {

constexpr double kPriorDeviation_m = 0.2;  // as for an initial pose
constexpr double kPriorDeviation_deg = 5.0;

struct MergeOptions {
  std::string map;
  std::string local;
  std::string out;
  std::string method = "ma1";
  std::vector<double> prior;  // x m, y m, heading degrees
  bool as_json = false;
};

struct Result {
  Pose2 map_from_local;
  mapping::merge::MergeRefusal refusal = mapping::merge::MergeRefusal::kNone;
  double seconds = 0.0;
};

Pose2 prior_pose(const MergeOptions& options) {
  return {options.prior[0], options.prior[1], wrapped_angle(radians(options.prior[2]))};
}

/// Lays B's contour where the prior says and searches around it, the heading about the contour's middle.
Result merged_with_prior(const OccupancyGrid& map, const OccupancyGrid& local, const Pose2& map_from_local) {
  std::vector<Point2> points;
  for (const Cell& cell : contour_cells(local)) points.emplace_back(map_from_local * local.geometry().centre_of(cell));
  const double heading_deviation_rad = radians(kPriorDeviation_deg);
  surveying::grid_registration::PosePrior prior;
  prior.position_in_map = map_from_local * mapping::merge::LocalCells{local}.middle_in_local();
  prior.covariance = Eigen::Vector3d{kPriorDeviation_m * kPriorDeviation_m, kPriorDeviation_m * kPriorDeviation_m,
                                     heading_deviation_rad * heading_deviation_rad}
                         .asDiagonal();
  const surveying::grid_registration::PriorMerge merged =
      surveying::grid_registration::prior_merge(map, points, prior, {});
  return {merged.map_from_guess * map_from_local, merged.refusal, 0.0};
}

Result merged_without_prior(const OccupancyGrid& map, const OccupancyGrid& local, const std::string& method) {
  if (method == "global") {
    const mapping::merge::MapMerge merged = surveying::grid_registration::global_merge(map, local);
    return {merged.map_from_local, merged.refusal, 0.0};
  }
  mapping::merge::MapMergeParams params;
  params.method = method == "ma2"   ? mapping::merge::MergeMethod::kMa2
                  : method == "ma3" ? mapping::merge::MergeMethod::kMa3
                  : method == "ma4" ? mapping::merge::MergeMethod::kMa4
                                    : mapping::merge::MergeMethod::kMa1;
  const mapping::merge::MapMerge merged = mapping::merge::map_merge(map, local, params);
  return {merged.map_from_local, merged.refusal, 0.0};
}

Result timed_merge(const OccupancyGrid& map, const OccupancyGrid& local, const MergeOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  Result result = options.method == "prior" ? merged_with_prior(map, local, prior_pose(options))
                                            : merged_without_prior(map, local, options.method);
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

/// The merges compare cell by cell: B is read at A's cell size, on cells that hold all of it.
OccupancyGrid at_resolution(const OccupancyGrid& grid, double resolution_m) {
  if (grid.resolution_m() == resolution_m) return grid;
  GridGeometry geometry = grid.geometry();
  geometry.width = static_cast<int>(std::ceil(grid.width() * grid.resolution_m() / resolution_m));
  geometry.height = static_cast<int>(std::ceil(grid.height() * grid.resolution_m() / resolution_m));
  geometry.resolution_m = resolution_m;
  return mapping::registration::transformed_grid(grid, {}, geometry);
}

void print_result(const Result& result, double acceptance, double agreement, const MergeOptions& options) {
  const Pose2& pose = result.map_from_local;
  const std::string refusal{name_of(result.refusal)};
  if (options.as_json) {
    const nlohmann::ordered_json json = {{"method", options.method},
                                         {"x_m", pose.x},
                                         {"y_m", pose.y},
                                         {"theta_deg", degrees(pose.theta)},
                                         {"acceptance", acceptance},
                                         {"surface_agreement", agreement},
                                         {"refusal", refusal},
                                         {"seconds", result.seconds}};
    std::cout << json.dump() << '\n';
    return;
  }
  std::printf("transform          x %.3f m  y %.3f m  turn %.3f deg  (A from B)\n", pose.x, pose.y,
              degrees(pose.theta));
  std::printf("acceptance         %.5f\nsurface agreement  %.4f\nrefusal            %s\ntime               %.4f s\n",
              acceptance, agreement, refusal.c_str(), result.seconds);
}

void run_merge(const MergeOptions& options) {
  const OccupancyGrid map = told_grid(options.map);
  const OccupancyGrid local = at_resolution(told_grid(options.local), map.resolution_m());
  const Result result = timed_merge(map, local, options);
  const OccupancyGrid moved = mapping::registration::transformed_grid(local, result.map_from_local, map.geometry());
  print_result(result, mapping::registration::acceptance(map, moved).value(),
               mapping::registration::surface_agreement(map, local, result.map_from_local), options);
  if (result.refusal != mapping::merge::MergeRefusal::kNone) {
    throw std::runtime_error(options.local + ": not merged into " + options.map + ": " +
                             std::string{name_of(result.refusal)});
  }
  write_grid(mapping::registration::overridden(map, moved), options.out);
}

}  // namespace

void add_map_merge(CLI::App& map) {
  auto options = std::make_shared<MergeOptions>();
  CLI::App* command = map.add_subcommand("merge", "find where B lies on A and lay its known cells over A");
  command->add_option("A", options->map, "map_server YAML")->required();
  command->add_option("B", options->local, "map_server YAML to lay over A")->required();
  command
      ->add_option("--method", options->method, "ma1 to ma4 as published; global: every shift; prior: around --prior")
      ->check(CLI::IsMember({"ma1", "ma2", "ma3", "ma4", "global", "prior"}))
      ->capture_default_str();
  command->add_option("--prior", options->prior, "where B's frame lies in A: X,Y,DEG (sigma 0.2 m, 5 deg)")
      ->delimiter(',')
      ->expected(3);
  command->add_option("--out", options->out, "merged map to write, on A's cells")->required();
  command->add_flag("--json", options->as_json, "one JSON object");
  command->callback([options] {
    if ((options->method == "prior") != (options->prior.size() == 3)) {
      throw CLI::ValidationError("--prior", "belongs to --method prior, and it to --prior X,Y,DEG");
    }
    run_merge(*options);
  });
}

}  // namespace deltamap::tool
