// SPDX-License-Identifier: Apache-2.0
// Runs the localizer alone over a CARMEN log and writes the trajectory (TUM) with the CPU time a scan: for tuning,
// without the drivers and the mapping around it.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <ctime>
#include <exception>
#include <fstream>
#include <iostream>
#include <vector>

#include "core/files/grid_file.hpp"
#include "core/geometry/angle.hpp"
#include "localization/localizer.hpp"
#include "localization/localizer_params.hpp"
#include "localization/sensor/weighing.hpp"
#include "tests/support/scans/carmen_feed.hpp"

namespace {

using namespace deltamap;

struct Options {
  std::string log;
  std::string map;
  std::string out;
  std::string figures;
  double laser_x_m = 0.0;
  double no_return_m = 80.0;
  std::vector<double> initial_pose;  // x, y, degrees
  std::uint64_t seed = 1;
  double from_s = 0.0;
  double to_s = 1e9;
};

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

void write_pose(std::ostream& out, const Estimate& estimate) {
  const Pose2& pose = estimate.map_from_robot;
  out << unix_seconds(estimate.time) << ' ' << pose.x << ' ' << pose.y << " 0 0 0 " << std::sin(0.5 * pose.theta) << ' '
      << std::cos(0.5 * pose.theta) << '\n';
}

void run(const Options& options, const localization::LocalizerParams& params) {
  std::optional<localization::particles::InitialPose> initial;
  if (options.initial_pose.size() == 3) {
    initial = localization::particles::InitialPose{
        {options.initial_pose[0], options.initial_pose[1], radians(options.initial_pose[2])}};
  }
  localization::Localizer localizer{params, std::make_shared<const OccupancyGrid>(read_grid(options.map)), initial,
                                    options.seed};
  const localization::sensor::LikelihoodField field{read_grid(options.map), params.field};
  std::ofstream out{options.out};
  out.setf(std::ios::fixed);
  out.precision(6);
  std::ofstream figures{options.figures};
  test::CarmenFeed feed{options.log, options.laser_x_m, options.no_return_m};
  std::vector<double> cpu_s;
  std::optional<Timestamp> began;
  while (auto scan = feed.next(localizer)) {
    began = began.value_or(scan->time);
    if (seconds(scan->time - *began) < options.from_s) continue;
    if (seconds(scan->time - *began) > options.to_s) break;
    const double start_s = cpu_seconds();
    const TrackedScan tracked = localizer.observe(std::move(*scan));
    cpu_s.push_back(cpu_seconds() - start_s);
    const Estimate& estimate = tracked.estimate;
    write_pose(out, estimate);
    figures << unix_seconds(estimate.time) << ' ' << static_cast<int>(estimate.state) << ' ' << estimate.n_eff << ' '
            << estimate.particles << ' ' << estimate.w_avg << ' ' << std::sqrt(estimate.covariance(0, 0)) << ' '
            << std::sqrt(estimate.covariance(1, 1)) << ' ' << std::sqrt(estimate.covariance(2, 2)) << ' '
            << localization::sensor::explained_share(
                   field, localization::motion::scoring_ends(tracked.scan, tracked.rays, 0), estimate.map_from_robot)
            << ' ' << estimate.covariance(0, 1) << '\n';
  }
  const localization::LocalizerCounts& counts = localizer.counts();
  std::cout << "recoveries " << counts.recoveries << ", searches " << counts.searches << ", gaps " << counts.gaps
            << '\n';
  std::sort(cpu_s.begin(), cpu_s.end());
  double sum_s = 0.0;
  for (const double s : cpu_s) sum_s += s;
  std::cout << "scans " << cpu_s.size() << ", CPU a scan: mean " << 1e3 * sum_s / static_cast<double>(cpu_s.size())
            << " ms, median " << 1e3 * cpu_s[cpu_s.size() / 2] << " ms, most " << 1e3 * cpu_s.back() << " ms\n";
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"runs the localizer over a CARMEN log"};
  Options options;
  localization::LocalizerParams params;
  app.add_option("log", options.log)->required();
  app.add_option("map", options.map)->required();
  app.add_option("out", options.out, "trajectory, TUM")->required();
  app.add_option("--figures", options.figures,
                 "state, N_eff, particles, w_avg, deviations, explained share and covariance of x and y of each scan")
      ->default_val("/dev/null");
  app.add_option("--laser", options.laser_x_m, "laser ahead of the robot, m");
  app.add_option("--no-return", options.no_return_m, "ranges from here on are no hits, m");
  app.add_option("--initial-pose", options.initial_pose, "X,Y,DEG of the robot")->delimiter(',')->expected(3);
  app.add_option("--seed", options.seed);
  app.add_option("--from", options.from_s, "seconds to leave out");
  app.add_option("--to", options.to_s, "seconds after which to end");
  app.add_option("--min", params.particles.min);
  app.add_option("--max", params.particles.max);
  app.add_option("--beams", params.beams);
  app.add_option("--evidence", params.particles.evidence_beams);
  app.add_option("--resample", params.particles.resample_below);
  app.add_option("--hit", params.field.hit_deviation_m);
  app.add_option("--random", params.field.random_share);
  app.add_option("--unknown", params.field.unknown_likelihood);
  app.add_option("--turn-per-turn", params.motion.turn_per_turn);
  app.add_option("--turn-per-metre", params.motion.turn_per_metre_rad);
  app.add_option("--metre-per-metre", params.motion.metre_per_metre);
  app.add_option("--metre-per-turn", params.motion.metre_per_turn_m);
  app.add_option("--position-floor", params.motion.position_floor_m);
  app.add_option("--heading-floor", params.motion.heading_floor_rad);
  app.add_option("--candidates", params.global.candidates_a_scan);
  app.add_option("--places", params.global.places);
  app.add_option("--place-evidence", params.hypothesis_bank.evidence_beams);
  app.add_option("--memory", params.hypothesis_bank.memory_steps);
  app.add_option("--headings", params.hypothesis_tracker.headings);
  app.add_option("--block", params.hypothesis_tracker.block_m);
  app.add_option("--refine", params.refinement.steps);
  app.add_option("--prior", params.refinement.prior_share);
  app.add_option("--alike", params.refinement.alike_beams);
  CLI11_PARSE(app, argc, argv);
  try {
    run(options, params);
  } catch (const std::exception& error) {
    std::cerr << "localization_bench: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
