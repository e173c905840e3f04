// SPDX-License-Identifier: Apache-2.0
// The live pipeline on a scripted drive, and the replay of what it recorded: what the daemon's tests hold against each
// other byte for byte.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>

#include "core/files/grid_file.hpp"
#include "daemon/pipeline.hpp"
#include "daemon/replay/replay_run.hpp"
#include "tests/support/bytes/scripted_port.hpp"
#include "tests/support/files/temporary_folder.hpp"
#include "tests/support/files/text_file.hpp"
#include "tests/support/scans/scripted_drive.hpp"
#include "tool/import_carmen.hpp"

namespace deltamap::test {

inline std::size_t lines_of(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

inline std::string first_difference(const std::string& one, const std::string& other) {
  if (one == other) return "";
  const auto differ = std::mismatch(one.begin(), one.end(), other.begin(), other.end());
  const auto at = static_cast<std::size_t>(differ.first - one.begin());
  const std::size_t line = one.rfind('\n', at == 0 ? 0 : at - 1) + 1;
  return "line " + std::to_string(lines_of(one.substr(0, at)) + 1) + ": " + one.substr(line, 100) + " | " +
         (line < other.size() ? other.substr(line, 100) : "");
}

class PipelineFixture : public testing::Test {
 protected:
  static constexpr double kDrive_s = 45.0;

  PipelineFixture() {
    write_drive(folder_.path() / "drive.log", kDrive_s);
    (void)tool::import_carmen(folder_.path() / "drive.log", folder_.path() / "drive.pcapng", std::nullopt);
    write_grid(small_room(false), folder_.path() / "room.yaml");
    settings_.initial_pose = pose_on_drive(0.0);
    settings_.localizer.particles.min = 200;
    settings_.localizer.particles.max = 200;
    settings_.recording.file = folder_.path() / "live.pcapng";
  }

  [[nodiscard]] daemon::Pipeline::Options options() const {
    daemon::Pipeline::Options options;
    options.start.map = std::make_shared<const OccupancyGrid>(read_grid(folder_.path() / "room.yaml"));
    options.first_map = grid_hash(*options.start.map);
    options.live = live_;
    options.control_patience_s = 60.0;  // this machine may be busy
    options.log = [](const std::string&) {};
    options.failed = [](const std::string& why) { FAIL() << why; };
    return options;
  }

  /// Plays the drive; `meanwhile` is called while it does. With a pause after each record nothing is played that the
  /// localizer has no time for, and there are scans for as long as `meanwhile` takes; without one the ports are faster
  /// than the localizer.
  daemon::RunReport run_live(
      std::chrono::microseconds pause,
      const std::function<void(const daemon::Pipeline&)>& meanwhile = [](const daemon::Pipeline&) {}) {
    std::atomic<const daemon::Telemetry*> telemetry = nullptr;
    std::atomic<bool> is_operated = true;
    ScriptedPorts::Brakes brakes;
    if (pause.count() > 0) {
      brakes.is_behind = [&telemetry] {
        const daemon::Telemetry* seen = telemetry;
        return seen == nullptr ||
               seen->scans.value() > seen->localized.value() + seen->dropped.value() + seen->scans_lost.value();
      };
      brakes.wants_scans = [&is_operated] { return is_operated.load(); };
    }
    ScriptedPorts ports{folder_.path() / "drive.pcapng", pause, brakes};
    auto played = ports.played();
    std::filesystem::create_directories(folder_.path() / "live");
    daemon::Pipeline::Options live = options();
    prepare_(live);
    live.out = folder_.path() / "live";
    live.mode = drivers::SessionMode::kListenOnly;
    live.open = [&ports](boost::asio::io_context& loop, drivers::port::PortId id, unsigned) {
      return ports.open(loop, id);
    };
    daemon::Pipeline pipeline{settings_, std::move(live)};
    telemetry = &pipeline.telemetry();
    meanwhile(pipeline);
    is_operated = false;
    EXPECT_EQ(played.wait_for(std::chrono::seconds(600)), std::future_status::ready);
    return pipeline.stop();
  }

  daemon::RunReport replay(const std::string& recording, const std::string& out) {
    daemon::ReplayJob job;
    job.recording = folder_.path() / recording;
    job.map = folder_.path() / "room.yaml";
    job.settings = settings_;
    job.out = folder_.path() / out;
    return daemon::run_replay(job, [](double) { return true; });
  }

  void expect_same_files(const std::string& one, const std::string& other) {
    for (const char* name : {"trajectory.tum", "localization.csv", "changes.jsonl", "map.pgm", "map.yaml"}) {
      const std::string content = content_of(folder_.path() / one / name);
      EXPECT_EQ(first_difference(content, content_of(folder_.path() / other / name)), "") << name;
      EXPECT_TRUE(std::string(name) == "changes.jsonl" || !content.empty()) << name;
    }
  }

  TemporaryFolder folder_;
  daemon::Settings settings_;
  std::shared_ptr<daemon::LiveSettings> live_;  ///< null: nothing is reloaded
  std::function<void(daemon::Pipeline::Options&)> prepare_ = [](daemon::Pipeline::Options&) {};  ///< of run_live()
};

}  // namespace deltamap::test
