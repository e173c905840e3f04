// SPDX-License-Identifier: Apache-2.0
// `deltamap export`, run in-process on a recording that was imported from a log: what went in comes out.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/base64.hpp"
#include "core/files/grid_file.hpp"
#include "drivers/carmen/carmen_log.hpp"
#include "tests/support/files/temporary_folder.hpp"
#include "tests/support/files/text_file.hpp"
#include "tests/support/files/tool_run.hpp"
#include "tool/export/foxglove.hpp"
#include "tool/export/mcap_writer.hpp"
#include "tool/export/text_exports.hpp"

namespace deltamap::tool {
namespace {

using test::run_deltamap;

constexpr int kScans = 10;
constexpr double kHalfUnitM = 0.0005 + 1e-6;
constexpr double kHalfHeadingUnit = 3.1416 / 4096.0;

/// A robot that drives along x, and turns; one beam of each scan brings nothing back.
std::string log_of_a_drive() {
  std::string log;
  for (int i = 0; i < kScans; ++i) {
    log += "FLASER 181";
    for (int beam = 0; beam < 181; ++beam)
      log += beam == 90 ? " 81.83" : " " + std::to_string(1.0 + 0.01 * beam + 0.1 * i);
    char pose[96];
    (void)std::snprintf(pose, sizeof pose, " %.3f 0 %.4f", 0.1 * i, 0.01 * i);
    log +=
        std::string(pose) + pose + " " + std::to_string(1000.0 + 0.2 * i) + " host " + std::to_string(0.2 * i) + "\n";
  }
  return log;
}

struct Recorded {
  test::TemporaryFolder folder;
  std::string log = folder.write("a.log", log_of_a_drive()).string();
  std::string file = (folder.path() / "a.pcapng").string();

  Recorded() {
    const auto run = run_deltamap({"import", "carmen", log, file, "--no-return", "80"});
    EXPECT_EQ(run.exit_code, 0) << run.errors;
  }
  [[nodiscard]] std::string exported(const std::string& format) const {
    const std::string out = (folder.path() / ("out." + format)).string();
    const auto run = run_deltamap({"export", format, file, out});
    EXPECT_EQ(run.exit_code, 0) << run.errors;
    return out;
  }
};

std::vector<drivers::carmen::CarmenScan> scans_of(const std::string& log) {
  std::vector<drivers::carmen::CarmenScan> scans;
  drivers::carmen::CarmenLog lines{log};
  while (const auto record = lines.next()) {
    if (const auto* scan = std::get_if<drivers::carmen::CarmenScan>(&*record)) scans.push_back(*scan);
  }
  return scans;
}

TEST(Export, GivesAnImportedLogBackWithItsTimesRangesAndPoses) {
  const Recorded recorded;
  const auto before = scans_of(recorded.log);
  const auto after = scans_of(recorded.exported("carmen"));
  ASSERT_EQ(after.size(), before.size());
  for (std::size_t i = 0; i < after.size(); ++i) {
    EXPECT_NEAR(seconds(after[i].time - before[i].time), 0.0, 2e-6);
    ASSERT_EQ(after[i].ranges_m.size(), 181u);
    for (std::size_t beam = 0; beam < 181; ++beam) {
      if (beam == 90) continue;
      EXPECT_NEAR(after[i].ranges_m[beam], before[i].ranges_m[beam], kHalfUnitM);
    }
    EXPECT_EQ(after[i].ranges_m[90], after[i].stated_max_range_m) << "nothing came back";
    EXPECT_NEAR(after[i].poses->odom_from_robot.x, before[i].poses->odom_from_robot.x, 2 * kHalfUnitM);
    EXPECT_NEAR(after[i].poses->odom_from_robot.theta, before[i].poses->odom_from_robot.theta, kHalfHeadingUnit);
    EXPECT_NEAR(after[i].first_bearing_rad, -M_PI / 2.0, 1e-6);
    EXPECT_NEAR(after[i].bearing_step_rad, M_PI / 180.0, 1e-6);
  }
}

TEST(Export, ImportsItsOwnCarmenLogToTheSameScans) {
  const Recorded recorded;
  const std::string log = recorded.exported("carmen");
  const std::string again = (recorded.folder.path() / "again.pcapng").string();
  ASSERT_EQ(run_deltamap({"import", "carmen", log, again}).exit_code, 0);
  const std::string first = (recorded.folder.path() / "first.csv").string();
  const std::string second = (recorded.folder.path() / "second.csv").string();
  ASSERT_EQ(run_deltamap({"export", "csv", recorded.file, first}).exit_code, 0);
  ASSERT_EQ(run_deltamap({"export", "csv", again, second}).exit_code, 0);
  const auto ranges_of = [](const std::string& file) {
    std::vector<std::string> ranges;
    std::ifstream in{file};
    for (std::string line; std::getline(in, line);) ranges.push_back(line.substr(line.rfind(',')));
    return ranges;
  };
  EXPECT_EQ(ranges_of(first).size(), kScans + 1u);
  EXPECT_EQ(ranges_of(first), ranges_of(second));
}

TEST(Export, WritesTheWheelsAsTrajectoryInOrderOfTimeAndEachTimeOnce) {
  const Recorded recorded;
  std::istringstream in{test::content_of(recorded.exported("tum"))};
  double before = 0.0;
  std::size_t lines = 0;
  for (std::string line; std::getline(in, line); ++lines) {
    std::istringstream words{line};
    double value = 0.0;
    std::vector<double> values;
    while (words >> value) values.push_back(value);
    ASSERT_EQ(values.size(), 8u) << line;
    EXPECT_GT(values[0], before);
    before = values[0];
  }
  EXPECT_GE(lines, static_cast<std::size_t>(kScans));
}

TEST(Export, LeavesOutWhatATrajectoryHasTwice) {
  const auto point = [](double at_s, double x) {
    return daemon::TrajectoryPoint{timestamp_from_ns(0) + duration_from_seconds(at_s), {x, 0.0, 0.0}};
  };
  std::ostringstream out;
  write_tum({point(2.0, 1.0), point(1.0, 2.0), point(2.0, 3.0)}, out);
  EXPECT_EQ(out.str(),
            "1.000000000 2.000000 0.000000 0 0 0 0.000000000 1.000000000\n"
            "2.000000000 1.000000 0.000000 0 0 0 0.000000000 1.000000000\n");
}

std::string folder_of_a_run(const test::TemporaryFolder& folder) {
  std::string rows = daemon::csv_header();
  for (std::uint32_t number = 0; number < 3; ++number) {
    daemon::LocalizationRow row;
    row.time = timestamp_from_ns(1'700'000'000'123'456'789) + std::chrono::seconds{number};
    row.number = number;
    row.map_from_robot = {1.0 + number, 2.0, 0.5};
    row.state = LocalizerState::kTracking;
    rows += daemon::csv_line(row);
  }
  (void)folder.write("localization.csv", rows);
  (void)folder.write("changes.jsonl", "");
  write_grid(OccupancyGrid{{4, 4, 0.05, {0.0, 0.0}}}, folder.path() / "map.yaml");
  return folder.path().string();
}

TEST(Export, GivesTheTrajectoryOfARunWithEveryDigitOfItsTimes) {
  const test::TemporaryFolder folder;
  const std::string run = folder_of_a_run(folder);
  const std::string out = run + "/out";
  ASSERT_EQ(run_deltamap({"export", "tum", run, out}).exit_code, 0);
  EXPECT_TRUE(test::content_of(out).starts_with("1700000000.123456789 1.000000 2.000000 0 0 0 "))
      << test::content_of(out);
  ASSERT_EQ(run_deltamap({"export", "csv", run, out}).exit_code, 0);
  EXPECT_NE(test::content_of(out).find("\n1700000001.123456789,1,tracking,2.000000,2.000000,0.500000,"),
            std::string::npos)
      << test::content_of(out);
  const auto mcap = run_deltamap({"export", "mcap", run, out, "--json"});
  ASSERT_EQ(mcap.exit_code, 0) << mcap.errors;
  EXPECT_EQ(nlohmann::json::parse(mcap.output)["count"], 5) << "three poses, its map, what its state is";
}

/// The records of an MCAP file: opcode and content.
std::vector<std::pair<int, std::string>> records_in(std::string bytes) {
  std::vector<std::pair<int, std::string>> records;
  for (std::size_t at = 0; at + 9 <= bytes.size();) {
    std::uint64_t size = 0;
    for (std::size_t i = 0; i < 8; ++i) size |= std::uint64_t{static_cast<unsigned char>(bytes[at + 1 + i])} << 8 * i;
    records.emplace_back(bytes[at], bytes.substr(at + 9, size));
    at += 9 + size;
  }
  return records;
}

TEST(Export, WritesMcapWithScansPosesAndWhatReadersSeekBy) {
  const Recorded recorded;
  const std::string bytes = test::content_of(recorded.exported("mcap"));
  const std::string magic{"\x89MCAP0\r\n", 8};
  ASSERT_TRUE(bytes.starts_with(magic) && bytes.ends_with(magic));
  std::map<int, int> of_file;
  std::map<int, int> of_chunks;
  int scans = 0;
  for (const auto& [opcode, content] : records_in(bytes.substr(8, bytes.size() - 16))) {
    ++of_file[opcode];
    if (opcode != 6) continue;
    for (const auto& [inner, message] : records_in(content.substr(8 + 8 + 8 + 4 + 4 + 8))) {
      ++of_chunks[inner];
      if (inner != 5) continue;
      const auto json = nlohmann::json::parse(message.substr(2 + 4 + 8 + 8));
      if (!json.contains("ranges")) continue;
      ++scans;
      EXPECT_EQ(json["frame_id"], "odom");
      EXPECT_EQ(json["ranges"][90], 0.0) << "nothing came back";
      EXPECT_EQ(json["ranges"].size(), 181u);
    }
  }
  EXPECT_EQ(scans, kScans);
  EXPECT_EQ(of_chunks[3], of_chunks[4]) << "a schema before each channel";
  for (const int opcode : {1, 2, 3, 4, 6, 7, 8, 11, 15}) EXPECT_GT(of_file[opcode], 0) << "opcode " << opcode;
}

TEST(Foxglove, WritesAMapFromItsLowestRowOnWithAByteACell) {
  OccupancyGrid map{{2, 2, 0.05, {-1.0, 2.0}}};
  map.set({0, 0}, CellState::kFree);
  map.set({1, 1}, CellState::kOccupied);
  const auto json = nlohmann::json::parse(foxglove::grid(timestamp_from_ns(1'500'000'000), "map", map));
  EXPECT_EQ(bytes_of_base64(json["data"].get<std::string>()), (std::string{"\0\x7F\x7F\xFF", 4}));
  EXPECT_EQ(json["column_count"], 2);
  EXPECT_EQ(json["pose"]["position"], (nlohmann::json{{"x", -1.0}, {"y", 2.0}, {"z", 0.0}}));
  EXPECT_EQ(json["timestamp"], (nlohmann::json{{"sec", 1}, {"nsec", 500000000}}));
}

TEST(Export, RefusesWhatCannotBe) {
  const Recorded recorded;
  const std::string folder = recorded.folder.path().string();
  const auto run = run_deltamap({"export", "carmen", folder, folder + "/x.log"});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_NE(run.errors.find("which holds no scans: give its recording"), std::string::npos) << run.errors;
  EXPECT_EQ(run_deltamap({"export", "tum", recorded.file, recorded.file}).exit_code, 1) << "over what it reads";
  EXPECT_EQ(run_deltamap({"export", "mcap", recorded.file, folder + "/x.mcap", "--recording", recorded.file}).exit_code,
            2);
  EXPECT_FALSE(std::filesystem::exists(folder + "/x.log")) << "nothing half-written";
}

TEST(Export, NeverTruncatesWhatItReads) {
  const Recorded recorded;
  const std::string folder = recorded.folder.path().string();
  const std::string part = folder + "/b.part";
  std::filesystem::copy_file(recorded.file, part);
  const auto size = std::filesystem::file_size(part);
  for (const char* format : {"tum", "csv", "carmen", "mcap"}) {
    const auto run = run_deltamap({"export", format, part, folder + "/b"});
    EXPECT_EQ(run.exit_code, 1) << format;
    EXPECT_NE(run.errors.find("b.part: is what is read"), std::string::npos) << run.errors;
    ASSERT_TRUE(std::filesystem::exists(part)) << format;
    EXPECT_EQ(std::filesystem::file_size(part), size) << format;
  }
  const auto beside = run_deltamap({"export", "mcap", folder, recorded.file, "--recording", recorded.file});
  EXPECT_NE(beside.errors.find("is what is read"), std::string::npos) << beside.errors;
}

}  // namespace
}  // namespace deltamap::tool
