// SPDX-License-Identifier: Apache-2.0
// Bags and MCAP files become recordings: the same scans, the same way.
#include "tool/import/import_messages.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <limits>
#include <stdexcept>

#include "core/geometry/angle.hpp"
#include "daemon/records/recording_decoder.hpp"
#include "drivers/port/byte_log.hpp"
#include "tests/support/files/temporary_folder.hpp"
#include "tests/tool/import/message_writers.hpp"
#include "tool/export/mcap_writer.hpp"

namespace deltamap::tool {
namespace {

constexpr double kBegin_s = 1'700'000'000.0;
constexpr int kScans = 20;

float range_of(int scan, int beam) { return static_cast<float>(1000 + 13 * ((7 * beam + scan) % 300)) / 1000.0F; }

std::vector<float> ranges_of(int scan) {
  std::vector<float> ranges_m;
  for (int beam = 0; beam < 181; ++beam) ranges_m.push_back(range_of(scan, beam));
  ranges_m[5] = std::numeric_limits<float>::infinity();
  ranges_m[6] = std::numeric_limits<float>::quiet_NaN();
  ranges_m[7] = 0.01F;  // nearer than the laser measures
  ranges_m[8] = 30.0F;  // at its longest range
  return ranges_m;
}

std::vector<TestMessage> drive(bool is_cdr, const std::string& scan_type, const std::string& odom_type) {
  std::vector<TestMessage> messages;
  for (int i = 0; i < kScans; ++i) {
    const double time_s = kBegin_s + 0.125 * i;
    messages.push_back({"/odom", odom_type, time_s, odometry_bytes(time_s, 0.05 * i, 0.01 * i, is_cdr)});
    TestScan scan{.time_s = time_s, .ranges_m = ranges_of(i)};
    messages.push_back({"/scan", scan_type, time_s, scan_bytes(scan, is_cdr)});
  }
  return messages;
}
std::vector<TestMessage> ros1_drive() { return drive(false, "sensor_msgs/LaserScan", "nav_msgs/Odometry"); }

struct Recorded {
  std::vector<Scan> scans;
  std::vector<Odometry> odometry;
};
Recorded recorded_in(const std::filesystem::path& file) {
  Recorded all;
  daemon::Settings settings;
  settings.laser.session.variant = {180, 100};
  daemon::RecordingDecoder decoder{settings};
  drivers::port::ByteLogReader reader{file};
  const daemon::RecordingDecoder::Sinks sinks{
      [&](Odometry&& odometry, std::uint32_t) { all.odometry.push_back(odometry); },
      [&](Scan&& scan) { all.scans.push_back(std::move(scan)); }};
  while (const auto record = reader.next()) decoder.feed(*record, sinks);
  return all;
}

class ImportMessages : public testing::Test {
 protected:
  MessageImport wanted(const std::string& bytes, bool is_bag) {
    std::ofstream(folder_.path() / "in", std::ios::binary) << bytes;
    MessageImport import;
    import.file = folder_.path() / "in";
    import.is_bag = is_bag;
    import.recording = folder_.path() / "out.pcapng";
    return import;
  }
  static std::string refusal(const MessageImport& import) {
    try {
      (void)import_messages(import);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  }
  void expect_the_drive(const ImportedMessages& done) const {
    EXPECT_EQ(done.carmen.survey.scans, static_cast<std::size_t>(kScans));
    const Recorded all = recorded_in(folder_.path() / "out.pcapng");
    ASSERT_EQ(all.scans.size(), static_cast<std::size_t>(kScans));
    for (int i = 0; i < kScans; ++i) {
      const Scan& scan = all.scans[static_cast<std::size_t>(i)];
      EXPECT_NEAR(seconds(scan.time.time_since_epoch()), kBegin_s + 0.125 * i, 1e-5);
      ASSERT_EQ(scan.beams.size(), 181u);
      for (int beam = 9; beam < 181; ++beam)
        EXPECT_FLOAT_EQ(scan.beams[static_cast<std::size_t>(beam)].range_m, range_of(i, beam)) << i << ' ' << beam;
      EXPECT_EQ(scan.beams[5].kind, BeamKind::kBeyondMaximum);
      EXPECT_EQ(scan.beams[6].kind, BeamKind::kNotValid);
      EXPECT_EQ(scan.beams[7].kind, BeamKind::kNotValid);
      EXPECT_EQ(scan.beams[8].kind, BeamKind::kBeyondMaximum);
    }
    const Pose2 way = motion_between(all.odometry.front().odom_from_robot, all.odometry.back().odom_from_robot);
    EXPECT_NEAR(way.x, 0.05 * (kScans - 1), 0.005) << "to a packet's millimetre, along its own heading";
    EXPECT_NEAR(way.theta, 0.01 * (kScans - 1), 0.002);
  }

  test::TemporaryFolder folder_;
};

TEST_F(ImportMessages, TakesScansAndOdometryOfABag) {
  expect_the_drive(import_messages(wanted(bag_of(ros1_drive(), "lz4"), true)));
}

TEST_F(ImportMessages, TakesScansAndOdometryOfMcapInBothOfRosEncodings) {
  expect_the_drive(import_messages(wanted(mcap_of(ros1_drive(), "ros1", ""), false)));
  const auto ros2 = drive(true, "sensor_msgs/msg/LaserScan", "nav_msgs/msg/Odometry");
  expect_the_drive(import_messages(wanted(mcap_of(ros2, "cdr", "zstd"), false)));
}

TEST_F(ImportMessages, ReadsXcdr2WhichAlignsDoublesToFourBytes) {
  for (const char kind : {char{7}, char{17}}) {
    auto ros2 = drive(true, "sensor_msgs/msg/LaserScan", "nav_msgs/msg/Odometry");
    for (TestMessage& message : ros2) {
      if (message.topic != "/odom") continue;
      const double i = std::round((message.time_s - kBegin_s) / 0.125);
      message.bytes = odometry_bytes(message.time_s, 0.05 * i, 0.01 * i, true, kind);
    }
    expect_the_drive(import_messages(wanted(mcap_of(ros2, "cdr", ""), false)));
  }
}

TEST_F(ImportMessages, ReadsTransformsInXcdr2WithAndWithoutTheSizeOfTheirList) {
  for (const bool sized : {true, false}) {
    std::vector<TestMessage> messages{{"/tf_static", "tf2_msgs/msg/TFMessage", kBegin_s,
                                       xcdr2_transform_bytes(kBegin_s, "base_link", "laser", {0.2, 0.1, 0.0}, sized)}};
    for (const TestMessage& message : drive(true, "sensor_msgs/msg/LaserScan", "nav_msgs/msg/Odometry")) {
      if (message.topic == "/scan") messages.push_back(message);
    }
    for (int i = 0; i < kScans; ++i) {
      const double time_s = kBegin_s + 0.125 * i;
      messages.push_back({"/tf", "tf2_msgs/msg/TFMessage", time_s,
                          xcdr2_transform_bytes(time_s, "odom", "base_link", {0.05 * i, 0.0, 0.01 * i}, sized)});
    }
    const ImportedMessages done = import_messages(wanted(mcap_of(messages, "cdr", ""), false));
    expect_the_drive(done);
    EXPECT_EQ(done.notes.size(), 3u) << "no message is left out";
    EXPECT_NE(done.notes.front().find("laser.mount.x_m=0.2 --set laser.mount.y_m=0.1"), std::string::npos);
  }
}

TEST_F(ImportMessages, LeavesOutCdrThatHasLengthsBetweenItsFields) {
  auto ros2 = drive(true, "sensor_msgs/msg/LaserScan", "nav_msgs/msg/Odometry");
  ros2.push_back({"/odom", "nav_msgs/msg/Odometry", kBegin_s + 3.0, odometry_bytes(kBegin_s + 3.0, 9.0, 0, true, 9)});
  const ImportedMessages done = import_messages(wanted(mcap_of(ros2, "cdr", ""), false));
  expect_the_drive(done);
  bool is_told = false;
  for (const std::string& note : done.notes) is_told = is_told || note.find("CDR of kind 9") != std::string::npos;
  EXPECT_TRUE(is_told);
}

TEST_F(ImportMessages, TakesThePoseFromTransformsAndTellsTheMountThatTheyHave) {
  std::vector<TestMessage> messages;
  messages.push_back({"/tf_static", "tf2_msgs/TFMessage", kBegin_s,
                      transform_bytes(kBegin_s, "base_link", "mast", 0.2, 0.0, radians(90.0))});
  messages.push_back({"/tf_static", "tf2_msgs/TFMessage", kBegin_s,
                      transform_bytes(kBegin_s, "/mast", "laser", 0.1, 0.0, radians(-80.0))});
  for (const TestMessage& message : ros1_drive()) {
    if (message.topic == "/scan") messages.push_back(message);
  }
  for (int i = 0; i < kScans; ++i) {
    const double time_s = kBegin_s + 0.125 * i;
    messages.push_back(
        {"/tf", "tf2_msgs/TFMessage", time_s, transform_bytes(time_s, "odom", "base_link", 0.05 * i, 0.0, 0.01 * i)});
  }
  const ImportedMessages done = import_messages(wanted(bag_of(messages, "none"), true));
  expect_the_drive(done);
  EXPECT_EQ(done.notes.front(),
            "settings to use: --set laser.max_range_m=30 --set laser.mount.x_m=0.2 --set laser.mount.y_m=0.1 --set "
            "laser.mount.yaw_deg=10");
}

TEST_F(ImportMessages, TellsTheMountThatFoxglovesScansCarry) {
  const auto pose = [](const std::string& x, const std::string& z, const std::string& w) {
    return R"("pose": {"position": {"x": )" + x + R"(, "y": 0.1, "z": 0.3}, "orientation": {"x": 0, "y": 0, "z": )" +
           z + R"(, "w": )" + w + "}}";
  };
  const std::string time = R"({"timestamp": {"sec": 1700000000, "nsec": 0}, "frame_id": )";
  const std::string scan = time + R"("base_link", )" + pose("0.2", "0.0871557427", "0.9961946981") +
                           R"(, "start_angle": -1, "end_angle": 1, "ranges": [1, 2, 3]})";
  const std::string odometry = time + R"("odom", )" + pose("1", "0", "1") + "}";
  const std::vector<TestMessage> messages{{"/scan", "foxglove.LaserScan", kBegin_s, scan},
                                          {"/odom", "foxglove.PoseInFrame", kBegin_s, odometry}};
  EXPECT_EQ(import_messages(wanted(mcap_of(messages, "json", ""), false)).notes.front(),
            "settings to use: --set laser.mount.x_m=0.2 --set laser.mount.y_m=0.1 --set laser.mount.yaw_deg=10");
}

TEST_F(ImportMessages, TellsALaserThatHangsUpsideDownByOneOfItsTransforms) {
  std::vector<TestMessage> messages = ros1_drive();
  messages.push_back({"/tf_static", "tf2_msgs/TFMessage", kBegin_s,
                      hanging_bytes(kBegin_s, "base_link", "mast", 0.2, 0.0, radians(90.0))});
  messages.push_back({"/tf_static", "tf2_msgs/TFMessage", kBegin_s,
                      transform_bytes(kBegin_s, "mast", "laser", 0.0, 0.1, radians(30.0))});
  const std::string at =
      "settings to use: --set laser.max_range_m=30 --set laser.mount.x_m=0.3 --set laser.mount.y_m=0 ";
  EXPECT_EQ(import_messages(wanted(bag_of(messages, "none"), true)).notes.front(),
            at + "--set laser.mount.yaw_deg=60 --set laser.mount.upside_down=true");
  messages.back().bytes = hanging_bytes(kBegin_s, "mast", "laser", 0.0, 0.1, radians(30.0));
  EXPECT_EQ(import_messages(wanted(bag_of(messages, "none"), true)).notes.front(), at + "--set laser.mount.yaw_deg=60")
      << "two that hang make one that stands";
}

TEST_F(ImportMessages, TurnsRoundScansThatAreToldClockwise) {
  std::vector<TestMessage> messages = ros1_drive();
  for (TestMessage& message : messages) {
    if (message.topic != "/scan") continue;
    const int i = static_cast<int>(std::lround((message.time_s - kBegin_s) / 0.125));
    std::vector<float> ranges_m = ranges_of(i);
    std::reverse(ranges_m.begin(), ranges_m.end());
    message.bytes = scan_bytes(
        {.time_s = message.time_s, .first_rad = 1.5707963, .step_rad = -0.017453293, .ranges_m = std::move(ranges_m)},
        false);
  }
  expect_the_drive(import_messages(wanted(bag_of(messages, "none"), true)));
}

TEST_F(ImportMessages, NamesTheTopicsThatThereAre) {
  MessageImport import = wanted(bag_of(ros1_drive(), "none"), true);
  import.scan_topic = "/front";
  const std::string missing = refusal(import);
  EXPECT_NE(missing.find("has no topic /front; it holds /odom (nav_msgs/Odometry, ros1, 20 messages), /scan "
                         "(sensor_msgs/LaserScan, ros1, 20 messages)"),
            std::string::npos)
      << missing;
  import.scan_topic = "/odom";
  EXPECT_NE(refusal(import).find("/odom holds no scans that are read"), std::string::npos);
  std::vector<TestMessage> two = ros1_drive();
  two.push_back({"/rear", "sensor_msgs/LaserScan", kBegin_s, two[1].bytes});
  EXPECT_NE(refusal(wanted(bag_of(two, "none"), true)).find("name one by --scan"), std::string::npos);
}

TEST_F(ImportMessages, UsesWhatIsBeforeACutAndLeavesBrokenMessagesOut) {
  std::vector<TestMessage> messages = ros1_drive();
  messages.push_back({"/scan", "sensor_msgs/LaserScan", kBegin_s + 3.0, "too short"});
  const std::string whole = bag_of(messages, "none");
  const ImportedMessages done = import_messages(wanted(whole + std::string(10, 'x'), true));
  expect_the_drive(done);
  EXPECT_TRUE(done.cut.starts_with("cut at byte " + std::to_string(whole.size()))) << done.cut;
  bool is_told = false;
  for (const std::string& note : done.notes)
    is_told = is_told || note.starts_with("1 message is left out; the first: /scan");
  EXPECT_TRUE(is_told);
}

TEST_F(ImportMessages, ReadsWhatWeExport) {
  const std::filesystem::path file = folder_.path() / "in";
  {
    McapWriter out{file};
    const auto scans = out.add_channel("/scan", "foxglove.LaserScan", "{}");
    const auto poses = out.add_channel("/odom", "foxglove.PoseInFrame", "{}");
    for (int i = 0; i < kScans; ++i) {
      const std::string stamp =
          R"("timestamp":{"sec":)" + std::to_string(1'700'000'000 + i / 8) + R"(,"nsec":)" +
          std::to_string(i % 8 * 125'000'000) + R"(},"frame_id":"odom","pose":{"position":{"x":)" +
          std::to_string(0.05 * i) + R"(,"y":0,"z":0},"orientation":{"x":0,"y":0,"z":)" +
          std::to_string(std::sin(0.005 * i)) + R"(,"w":)" + std::to_string(std::cos(0.005 * i)) + "}}";
      std::string ranges;
      for (int beam = 0; beam < 181; ++beam)
        ranges += (ranges.empty() ? "" : ",") + std::to_string(beam == 6 || beam == 7   ? 0.0F
                                                               : beam == 5 || beam == 8 ? 40.0F
                                                                                        : range_of(i, beam));
      const Timestamp time = timestamp_from_ns(1'700'000'000'000'000'000 + i * 125'000'000LL);
      out.write(poses, time, "{" + stamp + "}");
      out.write(scans, time,
                "{" + stamp + R"(,"start_angle":-1.5707963,"end_angle":1.5707963,"ranges":[)" + ranges + "]}");
    }
    out.close();
  }
  MessageImport import;
  import.file = file;
  import.no_return_m = 35.0;
  import.recording = folder_.path() / "out.pcapng";
  expect_the_drive(import_messages(import));
}

}  // namespace
}  // namespace deltamap::tool
