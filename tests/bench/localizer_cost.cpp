// SPDX-License-Identifier: Apache-2.0
// What the localizer alone costs, one job a run: ./dev bench localization calls it, also in its 32-bit build and under
// callgrind, which counts only what runs inside measured(). Prints "name value" lines; times are CPU time, medians.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <functional>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "core/grid/grid_patch.hpp"
#include "localization/localizer.hpp"
#include "localization/localizer_params.hpp"
#include "tests/bench/timed_hall.hpp"

/// The section that callgrind is told to count (--toggle-collect='measured*'). The empty instruction keeps the call
/// from becoming a jump.
[[gnu::noinline]] void measured(const std::function<void()>& work) {
  work();
  asm volatile("" ::: "memory");
}

namespace deltamap::bench {
namespace {

double cpu_s() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Seconds of CPU time that the work takes, median of the repetitions.
double median_s(int repetitions, const std::function<void()>& work) {
  std::vector<double> taken_s;
  for (int i = 0; i < repetitions; ++i) {
    const double began_s = cpu_s();
    measured(work);
    taken_s.push_back(cpu_s() - began_s);
  }
  std::sort(taken_s.begin(), taken_s.end());
  return taken_s[taken_s.size() / 2];
}

void print(const char* name, double value) { std::cout << name << ' ' << value << '\n'; }

struct Job {
  std::string what;
  int beams = 0;        ///< 0: all 181
  int repetitions = 9;  ///< 1 under callgrind
  std::size_t scans = 1500;
};

std::vector<DriveStep> drive(std::size_t scans) {
  HallLaps laps{80.0, 1};
  std::vector<DriveStep> steps;
  for (std::size_t i = 0; i < scans; ++i) steps.push_back(laps.next());
  return steps;
}

localization::Localizer localizer_at_start(const localization::LocalizerParams& params) {
  return {params, std::make_shared<const OccupancyGrid>(surveyed_hall()),
          localization::particles::InitialPose{HallLaps::start(), 0.05, radians(1.0)}, 1};
}

/// ParticleFilter::weigh alone, its normalization of the weights included.
void weigh(const Job& job) {
  const std::vector<DriveStep> steps = drive(1);
  const localization::LocalizerParams params;
  const localization::sensor::LikelihoodField field{surveyed_hall(), params.field};
  const auto rays = localization::motion::deskewed(steps.front().scan, {});
  const auto ends = localization::motion::scoring_ends(steps.front().scan, rays, job.beams);
  constexpr int kParticles = 500;
  constexpr int kRounds = 100;
  localization::particles::ParticleFilter filter{{.min = kParticles, .max = kParticles}, 1};
  const double heading_rad2 = radians(3.0) * radians(3.0);
  filter.start_around(HallLaps::start(), localization::motion::covariance_along(0.0, 0.01, 0.01, heading_rad2),
                      kParticles);
  std::int64_t sum = 0;
  const int rounds = job.repetitions == 1 ? 1 : kRounds;
  const double taken_s = median_s(job.repetitions, [&] {
    for (int i = 0; i < rounds; ++i) sum += filter.weigh(field, ends).front();
  });
  if (sum == 0) std::cerr << "every particle fits without a fault\n";
  const double weighed = static_cast<double>(rounds) * kParticles * static_cast<double>(ends.size());
  print("units", weighed);
  print("ns", 1e9 * taken_s / weighed);
}

/// Whole lap pieces through Localizer::observe. Answers the errors too.
void observe(const Job& job, const localization::LocalizerParams& params) {
  const std::vector<DriveStep> steps = drive(job.scans);
  std::vector<double> mean_us;
  std::vector<double> median_us;
  double error_m2 = 0.0;
  double particles = 0.0;
  for (int repetition = 0; repetition < job.repetitions; ++repetition) {
    localization::Localizer localizer = localizer_at_start(params);
    std::vector<double> taken_us;
    double sum_us = 0.0;
    error_m2 = particles = 0.0;
    for (const DriveStep& step : steps) {
      localizer.observe(step.odometry);
      Scan scan = step.scan;
      TrackedScan tracked;
      const double began_s = cpu_s();
      measured([&] { tracked = localizer.observe(std::move(scan)); });
      taken_us.push_back(1e6 * (cpu_s() - began_s));
      sum_us += taken_us.back();
      const double error_m = distance_between(tracked.estimate.map_from_robot, step.truth);
      error_m2 += error_m * error_m;
      particles += tracked.estimate.particles;
    }
    mean_us.push_back(sum_us / static_cast<double>(steps.size()));
    std::sort(taken_us.begin(), taken_us.end());
    median_us.push_back(taken_us[taken_us.size() / 2]);
  }
  std::sort(mean_us.begin(), mean_us.end());
  std::sort(median_us.begin(), median_us.end());
  const auto count = static_cast<double>(steps.size());
  print("units", count * job.repetitions);
  print("mean_us", mean_us[mean_us.size() / 2]);
  print("median_us", median_us[median_us.size() / 2]);
  print("rmse_m", std::sqrt(error_m2 / count));
  print("particles", particles / count);
}

/// Every scan moves and weighs 500 particles, draws them anew where N_eff asks for it, and refines the best one.
void update(const Job& job) {
  localization::LocalizerParams params;
  params.follow_surfaces = false;
  params.particles.min = params.particles.max = 500;
  params.beams = job.beams;
  params.update = {.distance_m = 0.0, .turn_rad = 0.0, .time_s = 1e-9};
  observe(job, params);
}

/// As delivered: KLD chooses the number of particles, refinement is on, a scan weighs when the robot has moved.
void track(const Job& job) {
  localization::LocalizerParams params;
  params.beams = job.beams;
  observe(job, params);
}

/// The same with particles.min 100: what a scan costs where the pose is sure and few particles are asked for.
void track_few(const Job& job) {
  localization::LocalizerParams params;
  params.particles.min = 100;
  params.beams = job.beams;
  observe(job, params);
}

/// A container of 5 x 5 m appears: the field's bytes around it computed and copied in; a whole rebuild beside it.
void patch(const Job& job) {
  const OccupancyGrid before = surveyed_hall();
  OccupancyGrid after = before;
  for (int row = 300; row < 400; ++row) {
    for (int column = 300; column < 400; ++column) after.set({column, row}, CellState::kOccupied);
  }
  const std::vector<CellChange> changes = changes_between(before, after);
  const localization::LocalizerParams params;
  localization::sensor::LikelihoodField field{before, params.field};
  print("units", job.repetitions);
  print("ms", 1e3 * median_s(job.repetitions,
                             [&] { field.apply(localization::prepared_field_patch(params, after, changes)); }));
  if (job.repetitions == 1) return;
  print("rebuild_ms", 1e3 * median_s(job.repetitions, [&] {
                        field = localization::sensor::LikelihoodField{after, params.field};
                      }));
}

/// VmRSS and VmHWM in MB of a process that holds a localizer with 2000 particles and nothing else.
void memory(const Job& job) {
  localization::LocalizerParams params;
  params.particles.min = params.particles.max = 2000;
  localization::Localizer localizer = localizer_at_start(params);
  HallLaps laps{80.0, 1};
  for (std::size_t i = 0; i < job.scans; ++i) {
    DriveStep step = laps.next();
    localizer.observe(step.odometry);
    (void)localizer.observe(std::move(step.scan));
  }
  std::ifstream status{"/proc/self/status"};
  for (std::string line; std::getline(status, line);) {
    for (const char* name : {"VmRSS", "VmHWM"}) {
      if (line.rfind(name, 0) == 0) print(name, std::strtod(line.c_str() + 6, nullptr) / 1024.0);
    }
  }
}

int run(int argc, char** argv) {
  const std::vector<std::pair<std::string, void (*)(const Job&)>> jobs{{"weigh", weigh}, {"update", update},
                                                                       {"track", track}, {"track_few", track_few},
                                                                       {"patch", patch}, {"memory", memory}};
  Job job;
  if (argc > 1) job.what = argv[1];
  if (argc > 2) job.beams = std::atoi(argv[2]);
  if (argc > 3) job.repetitions = std::atoi(argv[3]);
  if (argc > 4) job.scans = static_cast<std::size_t>(std::atoi(argv[4]));
  const auto chosen =
      std::find_if(jobs.begin(), jobs.end(), [&](const auto& known) { return known.first == job.what; });
  if (chosen == jobs.end() || job.repetitions < 1 || job.scans < 1) {
    std::cerr << "usage: localizer_cost weigh|update|track|track_few|patch|memory [BEAMS [REPETITIONS [SCANS]]]\n";
    return 2;
  }
  chosen->second(job);
  return 0;
}

}  // namespace
}  // namespace deltamap::bench

int main(int argc, char** argv) { return deltamap::bench::run(argc, argv); }
