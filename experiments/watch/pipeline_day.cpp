// SPDX-License-Identifier: Apache-2.0
#include "experiments/watch/pipeline_day.hpp"

#include <malloc.h>

#include <algorithm>
#include <cmath>
#include <future>
#include <iostream>
#include <limits>
#include <mutex>
#include <stdexcept>
#include <utility>

#include "core/files/scratch_folder.hpp"
#include "daemon/maps/store_opening.hpp"
#include "daemon/pipeline.hpp"
#include "daemon/system/used_memory.hpp"
#include "experiments/drive/first_map.hpp"
#include "experiments/drive/virtual_ports.hpp"

namespace deltamap::experiments {
namespace {

constexpr double kHour_s = 3600.0;
constexpr double kLeastSamples = 8.0;
constexpr double kLook_s = 5.0;  // of the drive, between two looks at the heap
constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

double megabytes(double bytes) { return bytes / (1024.0 * 1024.0); }

double heap_mb() {
  const struct mallinfo2 heap = mallinfo2();
  return megabytes(static_cast<double>(heap.uordblks + heap.hblkhd));
}

/// Looks at the memory while the drive goes on.
class MemoryBook {
 public:
  MemoryBook(double drive_s, std::function<void(const MemorySample&)> sampled)
      : drive_s_{drive_s}, every_s_{std::min(kHour_s, drive_s / kLeastSamples)}, sampled_{std::move(sampled)} {}

  /// False once the drive is over.
  bool look(double passed_s) {
    const bool is_sample = passed_s >= every_s_ * static_cast<double>(samples_.size() + 1);
    if (is_sample || passed_s >= next_look_s_) {
      least_mb_ = std::min(least_mb_, heap_mb());
      next_look_s_ = passed_s + kLook_s;
    }
    if (is_sample) {
      samples_.push_back(
          {passed_s, std::exchange(least_mb_, kNone_mb), megabytes(static_cast<double>(daemon::resident_bytes()))});
      if (sampled_) sampled_(samples_.back());
    }
    return passed_s < drive_s_;
  }
  [[nodiscard]] std::vector<MemorySample> samples() const { return samples_; }

 private:
  static constexpr double kNone_mb = 1e9;

  double drive_s_;
  double every_s_;
  std::function<void(const MemorySample&)> sampled_;
  double least_mb_ = kNone_mb;
  double next_look_s_ = 0.0;
  std::vector<MemorySample> samples_;
};

/// Told once, by whichever thread is first: the drive is over, or a stage has failed.
class End {
 public:
  void tell(const std::string& why = {}) {
    const std::lock_guard lock{telling_};
    if (!std::exchange(told_, true)) end_.set_value(why);
  }
  /// Empty where nothing has failed.
  std::string wait() { return end_.get_future().get(); }

 private:
  std::mutex telling_;
  bool told_ = false;
  std::promise<std::string> end_;
};

/// How much the last hour has more than the hour in which the world has settled.
double growth(const std::vector<MemorySample>& samples, double MemorySample::*memory) {
  const auto settled = std::find_if(samples.begin(), samples.end(),
                                    [](const MemorySample& s) { return s.passed_s >= kSettling_h * kHour_s; });
  const bool is_long_enough = settled != samples.end() && samples.back().passed_s >= (kSettling_h + 1.0) * kHour_s;
  return is_long_enough ? samples.back().*memory - (*settled).*memory : kNothing;
}

/// Everything that a run can write.
daemon::Settings settings_in(const std::filesystem::path& folder, const MappingRun& run) {
  daemon::Settings settings = run.settings;
  settings.seed = run.drive.seed;
  settings.map.store = folder / "store.sqlite";
  settings.recording.file = folder / "bytes.pcapng";
  settings.recording.max_gigabytes = 1.0;
  return settings;
}

}  // namespace

double PipelineDay::heap_growth_mb() const { return growth(samples, &MemorySample::heap_mb); }
double PipelineDay::resident_growth_mb() const { return growth(samples, &MemorySample::resident_mb); }

PipelineDay pipeline_day(const MappingRun& run, std::function<void(const MemorySample&)> sampled) {
  const ScratchFolder folder;
  MemoryBook book{60.0 * run.minutes, std::move(sampled)};
  End end;
  VirtualPorts ports{run.scenario, run.drive, [&](double passed_s) {
                       const bool goes_on = book.look(passed_s);
                       if (!goes_on) end.tell();
                       return goes_on;
                     }};
  daemon::Settings settings = settings_in(folder.path(), run);
  settings.initial_pose = ports.map_from_robot();
  const OccupancyGrid first = *first_map(run.scenario);
  daemon::OpenedStore opened = daemon::open_store(settings.map.store, first);
  daemon::Pipeline::Options options;
  options.start = opened.start;
  options.first_map = grid_hash(first);
  options.store = std::move(opened.store);
  options.out = folder.path();
  options.mode = drivers::SessionMode::kListenOnly;
  options.log = [](const std::string&) {};
  PipelineDay day;
  std::mutex warning;
  options.warn = [&](const std::string& line) {
    const std::lock_guard lock{warning};
    std::clog << "pipeline: " << line << std::endl;
    day.warnings.push_back(line);
  };
  options.open = [&](boost::asio::io_context& loop, drivers::port::PortId id, unsigned) {
    return ports.open(loop, id);
  };
  options.failed = [&](const std::string& why) { end.tell(why); };
  daemon::Pipeline pipeline{settings, std::move(options)};
  ports.follow(pipeline.telemetry());
  if (const std::string why = end.wait(); !why.empty()) throw std::runtime_error("the pipeline has failed: " + why);
  day.report = pipeline.stop();
  day.samples = book.samples();
  return day;
}

Outcome outcome_of(const PipelineDay& day) {
  const daemon::RunReport& report = day.report;
  Outcome outcome;
  outcome.numbers = {{"scans", static_cast<double>(report.scans.localized)},
                     {"revisions", static_cast<double>(report.changes.accepted())},
                     {"not_followed_s", report.time_lost_s + report.time_global_s},
                     {"warnings", static_cast<double>(day.warnings.size())},
                     {"last_heap_mb", day.samples.back().heap_mb},
                     {"heap_growth_mb", day.heap_growth_mb()},
                     {"resident_growth_mb", day.resident_growth_mb()}};
  outcome.scans = ScanTable{{"t_s", "heap_mb", "resident_mb"}};
  for (const MemorySample& sample : day.samples) {
    outcome.scans.add({sample.passed_s, sample.heap_mb, sample.resident_mb});
  }
  return outcome;
}

}  // namespace deltamap::experiments
