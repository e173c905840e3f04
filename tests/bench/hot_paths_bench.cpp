// SPDX-License-Identifier: Apache-2.0
// What one scan costs on its way through the house, step by step: ./dev bench. The paper's hall, its containers solid,
// 181 beams, 500 particles.
#include <benchmark/benchmark.h>

#include <memory>

#include "core/channel.hpp"
#include "localization/localizer.hpp"
#include "localization/localizer_params.hpp"
#include "localization/motion/deskew.hpp"
#include "localization/sensor/weighing.hpp"
#include "mapping/merge/map_merge.hpp"
#include "mapping/store_scan.hpp"
#include "tests/support/merge/merge_trial.hpp"
#include "tests/support/scans/cast_scan.hpp"

namespace deltamap {
namespace {

constexpr double kScanPeriodS = 0.107;
const Pose2 kStart{2.5, 2.5, 0.0};

std::shared_ptr<const OccupancyGrid> hall() {
  static const auto grid = [] {
    const OccupancyGrid fine = test::drawn_warehouse(1);
    return std::make_shared<const OccupancyGrid>(
        mapping::registration::transformed_grid(fine, {}, {720, 720, 0.05, fine.geometry().origin}));
  }();
  return grid;
}

Timestamp time_of(int step) {
  return timestamp_from_ns(1'700'000'000'000'000'000) + duration_from_seconds(step * kScanPeriodS);
}

Pose2 pose_at(int step) { return {kStart.x + 0.04 * (step % 600), kStart.y, 0.0}; }

/// Enough scans of a drive down the first corridor, so that casting is not measured.
const std::vector<Scan>& scans() {
  static const std::vector<Scan> drive = [] {
    Random random{1};
    std::vector<Scan> cast;
    for (int step = 0; step < 600; ++step)
      cast.push_back(test::cast_scan(*hall(), pose_at(step), time_of(step), {}, random));
    return cast;
  }();
  return drive;
}

Odometry odometry_at(int step) {
  Odometry odometry;
  odometry.time = time_of(step);
  odometry.odom_from_robot = pose_at(step);
  odometry.speed_m_per_s = 0.04 / kScanPeriodS;
  return odometry;
}

void weigh_one_particle(benchmark::State& state) {
  const localization::sensor::LikelihoodField field{*hall(), {}};
  const auto rays = localization::motion::deskewed(scans().front(), {});
  const auto ends = localization::motion::scoring_ends(scans().front(), rays, static_cast<int>(state.range(0)));
  Random random{1};
  std::vector<Pose2> particles;
  for (int i = 0; i < 500; ++i)
    particles.push_back({kStart.x + random.normal(0.1), kStart.y + random.normal(0.1), random.normal(0.05)});
  std::size_t next = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(localization::sensor::misfit_steps(field, ends, particles[next]));
    next = next + 1 == particles.size() ? 0 : next + 1;
  }
  state.counters["per_beam"] = benchmark::Counter(
      static_cast<double>(ends.size()), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(weigh_one_particle)->ArgName("beams")->Arg(60)->Arg(0);

/// Drives through `scans`, starting anew at the end of the corridor; answers the tracked scans of one lap.
template <typename Use>
void drive(benchmark::State& state, int beams, const Use& use) {
  localization::LocalizerParams params;
  params.particles.min = params.particles.max = 500;
  params.beams = beams;
  std::unique_ptr<localization::Localizer> localizer;
  int step = 0;
  for (auto _ : state) {
    if (step % 600 == 0) {
      state.PauseTiming();
      localizer =
          std::make_unique<localization::Localizer>(params, hall(), localization::particles::InitialPose{kStart}, 1);
      state.ResumeTiming();
    }
    use(*localizer, step % 600);
    ++step;
  }
}

void localize_one_scan(benchmark::State& state) {
  drive(state, static_cast<int>(state.range(0)), [](localization::Localizer& localizer, int step) {
    localizer.observe(odometry_at(step));
    benchmark::DoNotOptimize(localizer.observe(scans()[static_cast<std::size_t>(step)]));
  });
}
BENCHMARK(localize_one_scan)->ArgName("beams")->Arg(60)->Arg(0)->Unit(benchmark::kMicrosecond);

void look_for_changes_in_one_scan(benchmark::State& state) {
  localization::LocalizerParams params;
  localization::Localizer localizer{params, hall(), localization::particles::InitialPose{kStart}, 1};
  std::vector<TrackedScan> tracked;
  for (int step = 0; step < 600; ++step) {
    localizer.observe(odometry_at(step));
    tracked.push_back(localizer.observe(scans()[static_cast<std::size_t>(step)]));
  }
  mapping::StoreScan store{mapping::StoreScanParams{}, 1};
  std::size_t next = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(store.observe(tracked[next]));
    next = next + 1 == tracked.size() ? 0 : next + 1;
  }
}
BENCHMARK(look_for_changes_in_one_scan)->Unit(benchmark::kMicrosecond);

/// A container of 5 × 5 m in a map of 720 × 720 cells.
void patch_the_field(benchmark::State& state) {
  OccupancyGrid changed = *hall();
  test::fill_box(changed, {15.5, 8.0}, {19.5, 13.0}, CellState::kOccupied);
  const auto changes = changes_between(*hall(), changed);
  const localization::LocalizerParams params;
  for (auto _ : state) benchmark::DoNotOptimize(localization::prepared_field_patch(params, changed, changes));
}
BENCHMARK(patch_the_field)->Unit(benchmark::kMicrosecond);

void merge_two_maps(benchmark::State& state) {
  const OccupancyGrid fine = test::drawn_warehouse(1);
  const OccupancyGrid map = test::moved_grid(test::part_of(fine, 0.0, 0.8), {}, 0.1);
  const OccupancyGrid local = test::moved_grid(test::part_of(fine, 0.2, 1.0), {0.6, -0.4, radians(37.3)}, 0.1);
  mapping::merge::MapMergeParams params;
  params.method = static_cast<mapping::merge::MergeMethod>(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(mapping::merge::map_merge(map, local, params));
}
BENCHMARK(merge_two_maps)->ArgName("MA")->DenseRange(0, 3)->Unit(benchmark::kMillisecond);

void hand_a_scan_over(benchmark::State& state) {
  Channel<Scan> channel{8};
  Scan scan = scans().front();
  for (auto _ : state) {
    (void)channel.try_send(std::move(scan));
    scan = *channel.try_receive();
  }
}
BENCHMARK(hand_a_scan_over);

}  // namespace
}  // namespace deltamap

BENCHMARK_MAIN();
