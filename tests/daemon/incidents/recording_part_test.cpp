// SPDX-License-Identifier: Apache-2.0
// The parts of a recording that is a ring, of a daemon in virtual time: each replays from its beginning.
#include <gtest/gtest.h>

#include "core/files/grid_file.hpp"
#include "daemon/records/live_recording.hpp"
#include "daemon/records/recording_parts.hpp"
#include "tests/support/daemon/incident_drive.hpp"

namespace deltamap::daemon {
namespace {

/// Records in a ring, and nothing else.
class RingListener : public RunListener {
 public:
  RingListener(LiveRecording::Options options, Telemetry& telemetry)
      : recording_{std::move(options), telemetry, [](const std::string& line) { ADD_FAILURE() << line; }} {}

  void hear(const drivers::port::ByteRecord& record, Timestamp now) override { recording_.write(record, now); }
  void hear(std::shared_ptr<const Checkpoint> checkpoint, Timestamp now) override {
    recording_.begin_part(*checkpoint, now);
  }
  void close(Timestamp now) override { recording_.close(now); }
  void hear_of_loss() override {}
  void hear(const LocalizationRow&, Timestamp) override {}
  control::CommandOutcome hear(const MarkOrder&, Timestamp) override { return {}; }
  void look(Timestamp) override {}

 private:
  LiveRecording recording_;
};

class RecordingPart : public test::IncidentDrive {
 protected:
  std::unique_ptr<RunListener> listener(Telemetry& telemetry) override {
    const std::uint64_t hash = grid_hash(*map_);
    return std::make_unique<RingListener>(
        LiveRecording::Options{.file = file_,
                               .bauds = {settings_.robot.session.baud, settings_.laser.session.baud},
                               .first_notes = first_notes(settings_, hash, {hash, 0, {map_, 0}}),
                               .began = world_->now(),
                               .ring = RingLimits{.keep_hours = 0.1},  // parts of 36 s
                               .part_notes = [this](const Checkpoint& from) { return part_notes(settings_, from); }},
        telemetry);
  }
  std::filesystem::path file_ = folder_.path() / "ring.pcapng";
};

TEST_F(RecordingPart, ReplaysFromItsBeginning) {
  write_grid(*map_, folder_.path() / "site.yaml");
  start();
  drive(100.0);
  daemon_->listener()->close(world_->now());
  const std::vector<std::filesystem::path> parts = parts_of(file_);
  ASSERT_EQ(parts.size(), 2u);
  for (const std::filesystem::path& part : {parts[1], file_}) {
    double farthest_m = 0.0;
    std::size_t compared = 0;
    ReplayJob job;
    job.recording = part;
    job.map = folder_.path() / "site.yaml";
    job.settings = settings_of_a_part(settings_);
    job.out = folder_.path() / "again";
    job.watch.scan = [&](const ReplayedScan& scan) {
      EXPECT_EQ(scan.row.state, LocalizerState::kTracking);
      const auto live = poses_.find(scan.row.time);
      if (live == poses_.end()) return;
      ++compared;
      farthest_m = std::max(farthest_m, distance_between(live->second, scan.row.map_from_robot));
    };
    const RunReport report = run_replay(job, [](double) { return true; });
    EXPECT_EQ(report.journal, "not obeyed: the recording begins in mid-run");
    EXPECT_GT(compared, 100u);
    EXPECT_LT(farthest_m, 0.1);
  }
}

}  // namespace
}  // namespace deltamap::daemon
