// SPDX-License-Identifier: Apache-2.0
#include "tool/export/mcap_export.hpp"

#include <map>

#include "core/files/grid_file.hpp"
#include "daemon/records/journal.hpp"
#include "drivers/port/byte_log.hpp"
#include "mapping/store/map_store.hpp"
#include "tool/export/foxglove.hpp"
#include "tool/export/mcap_writer.hpp"
#include "tool/export/posed_scans.hpp"
#include "tool/view/run_folder.hpp"

namespace deltamap::tool {
namespace {

constexpr const char* kMapFrame = "map";
constexpr const char* kOdomFrame = "odom";
constexpr std::string_view kPartsOfBegin = "began from";  // notes that no person reads
constexpr std::string_view kPartsOfOrder = "map order";

class FoxgloveFile {
 public:
  explicit FoxgloveFile(const std::filesystem::path& file) : writer_{file} {}

  void write(const std::string& topic, const char* message, Timestamp time, const std::string& json) {
    auto channel = channels_.find(topic);
    if (channel == channels_.end()) {
      channel = channels_
                    .emplace(topic, writer_.add_channel(topic, std::string("foxglove.") + message,
                                                        foxglove::schema_of(message)))
                    .first;
    }
    writer_.write(channel->second, time, json);
  }
  [[nodiscard]] std::uint64_t close() {
    writer_.close();
    return writer_.messages();
  }

 private:
  McapWriter writer_;
  std::map<std::string, McapWriter::Channel> channels_;
};

/// Where a run has placed its scans, by the time of their first beams.
using PlacedScans = std::map<Timestamp, Pose2>;

std::string words_of_change(const daemon::ChangeNote& change) {
  const std::string what = change.revision ? "revision " + std::to_string(*change.revision) : "refused";
  return what + ": " + std::to_string(change.added) + " cells occupied, " + std::to_string(change.freed) + " free" +
         (change.reason.empty() ? "" : ", " + change.reason);
}

/// M_0 from the first scan on, each revision from its time on.
void add_maps(const std::filesystem::path& folder, Timestamp began, FoxgloveFile& out) {
  const std::filesystem::path history = folder / "map_store.sqlite";
  if (!std::filesystem::exists(history)) {
    const std::filesystem::path newest = folder / "map.yaml";
    if (std::filesystem::exists(newest))
      out.write("/map", "Grid", began, foxglove::grid(began, kMapFrame, read_grid(newest)));
    return;
  }
  const auto store = mapping::store::MapStore::to_read(history);
  out.write("/map", "Grid", began, foxglove::grid(began, kMapFrame, store.grid(0)));
  for (const mapping::store::StoredRevision& revision : store.history()) {
    if (revision.refused || revision.number == 0) continue;
    out.write("/map", "Grid", revision.time, foxglove::grid(revision.time, kMapFrame, store.grid(revision.number)));
  }
}

PlacedScans add_run(const std::filesystem::path& folder, FoxgloveFile& out, McapResult& result) {
  const RunFolder run = read_run_folder(folder);
  result.warnings.insert(result.warnings.end(), run.notes.begin(), run.notes.end());
  add_maps(folder, run.rows.front().time, out);
  PlacedScans placed;
  const daemon::LocalizationRow* before = nullptr;
  for (const daemon::LocalizationRow& row : run.rows) {
    placed[row.time] = row.map_from_robot;
    out.write("/pose", "PoseInFrame", row.time, foxglove::pose_in_frame(row.time, kMapFrame, row.map_from_robot));
    if (before == nullptr || before->state != row.state) {
      const bool is_lost = row.state == LocalizerState::kLost;
      out.write("/log", "Log", row.time,
                foxglove::log(row.time, is_lost ? foxglove::Level::kWarning : foxglove::Level::kInfo, "localizer",
                              daemon::state_line(row)));
    }
    before = &row;
  }
  for (const daemon::ChangeNote& change : run.changes) {
    out.write("/log", "Log", change.time,
              foxglove::log(change.time, foxglove::Level::kInfo, "map", words_of_change(change)));
  }
  return placed;
}

void add_notes(const std::string& recording, FoxgloveFile& out) {
  drivers::port::ByteLogReader reader{recording};
  while (const auto record = reader.next()) {
    const std::string& note = record->note;
    if (note.empty() || note.starts_with(kPartsOfBegin) || note.starts_with(kPartsOfOrder)) continue;
    const auto level = note == daemon::kGapNote ? foxglove::Level::kWarning : foxglove::Level::kInfo;
    out.write("/log", "Log", record->stamp, foxglove::log(record->stamp, level, "recording", note));
  }
}

void add_recording(const McapSource& source, const PlacedScans& placed, FoxgloveFile& out, McapResult& result) {
  std::uint64_t not_placed = 0;
  const PosedScanSinks sinks{[&](const Odometry& odometry, const Pose2& odom_from_robot) {
                               out.write("/odom", "PoseInFrame", odometry.time,
                                         foxglove::pose_in_frame(odometry.time, kOdomFrame, odom_from_robot));
                             },
                             [&](const Scan& scan, const Pose2& odom_from_robot) {
                               const auto in_map = placed.find(scan.time);
                               if (!placed.empty() && in_map == placed.end()) {
                                 ++not_placed;
                                 return;
                               }
                               const char* frame = placed.empty() ? kOdomFrame : kMapFrame;
                               const Pose2 frame_from_robot = placed.empty() ? odom_from_robot : in_map->second;
                               out.write("/scan", "LaserScan", scan.time,
                                         foxglove::laser_scan(scan, frame, frame_from_robot * scan.robot_from_laser));
                             }};
  const drivers::port::LogFaults faults = read_posed_scans(*source.recording, source.settings, sinks);
  const std::vector<std::string> lines = faults.lines();
  result.warnings.insert(result.warnings.end(), lines.begin(), lines.end());
  if (not_placed > 0) {
    result.warnings.push_back(*source.recording + ": " + std::to_string(not_placed) +
                              " of its scans have no pose in the run and are left out");
  }
  add_notes(*source.recording, out);
}

}  // namespace

McapResult export_mcap(const McapSource& source, const std::filesystem::path& file) {
  McapResult result;
  FoxgloveFile out{file};
  PlacedScans placed;
  if (source.run) placed = add_run(*source.run, out, result);
  if (source.recording) add_recording(source, placed, out, result);
  result.messages = out.close();
  return result;
}

}  // namespace deltamap::tool
