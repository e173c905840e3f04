// SPDX-License-Identifier: Apache-2.0
#include "daemon/check_config.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <map>

#include "core/files/file_lock.hpp"
#include "core/files/grid_file.hpp"
#include "daemon/dashboard/server.hpp"
#include "daemon/kept/kept_drive.hpp"
#include "daemon/kept/kept_pose.hpp"
#include "daemon/outputs/state_folders.hpp"
#include "daemon/sockets/listening_socket.hpp"
#include "daemon/start_banner.hpp"
#include "daemon/telemetry/version.hpp"
#include "mapping/store/map_store.hpp"
#include "tests/support/files/temporary_folder.hpp"
#include "tests/support/worlds/drawn_grid.hpp"

namespace deltamap::daemon {
namespace {

namespace fs = std::filesystem;
using Level = Finding::Level;

/// A machine with a map and nothing else.
class CheckConfig : public testing::Test {
 protected:
  CheckConfig() {
    write_grid(first_, folder_.path() / "hall.yaml");
    settings_.map.file = folder_.path() / "hall.yaml";
    settings_.map.store = folder_.path() / "state/store.sqlite";
    settings_.robot.port = "/nowhere/robot";
    settings_.laser.port = "/nowhere/laser";
  }
  [[nodiscard]] Finding finding(const std::string& about) const {
    for (const Finding& one : check_config(settings_, "robot.yaml", "")) {
      if (one.about == about) return one;
    }
    return {Level::kError, about, "nothing was found"};
  }
  [[nodiscard]] bool would_start() const { return !has_error(check_config(settings_, "robot.yaml", "")); }
  /// Every file below the folder with size and time of its last change.
  [[nodiscard]] std::map<fs::path, std::pair<std::uintmax_t, fs::file_time_type>> files() const {
    std::map<fs::path, std::pair<std::uintmax_t, fs::file_time_type>> all;
    for (const auto& entry : fs::recursive_directory_iterator(folder_.path())) {
      all[entry.path()] = {entry.is_regular_file() ? entry.file_size() : 0, entry.last_write_time()};
    }
    return all;
  }
  void write_store() const {
    fs::create_directories(folder_.path() / "state");
    mapping::store::MapStore store{settings_.map.store, first_};
    OccupancyGrid changed = first_;
    changed.set({0, 0}, CellState::kFree);
    MapRevision revision;
    revision.number = 1;
    revision.changes = changes_between(first_, changed);
    revision.map = std::make_shared<const OccupancyGrid>(std::move(changed));
    store.append(revision, {});
    store.append_refusal({}, {});
  }

  test::TemporaryFolder folder_;
  OccupancyGrid first_ = test::drawn_grid({"#. ", " .#"}, 0.05, {0.0, 0.0});
  Settings settings_;
};

TEST_F(CheckConfig, ReadsTheMapWholeAndCountsItsCells) {
  EXPECT_EQ(finding("map").text, settings_.map.file + ": 3 x 2 cells of 0.05 m: 2 free, 2 occupied, 2 unknown");
  fs::resize_file(folder_.path() / "hall.pgm", fs::file_size(folder_.path() / "hall.pgm") - 1);
  EXPECT_EQ(finding("map").level, Level::kError);
  EXPECT_NE(finding("map").text.find("cut short"), std::string::npos);
  EXPECT_FALSE(would_start());
  settings_.map.file.clear();
  EXPECT_EQ(finding("map").text, "robot.yaml: 'map.file' names no map");
}

TEST_F(CheckConfig, AStartPoseOffTheMapIsAnErrorThatNamesTheMapsExtent) {
  settings_.initial_pose = Pose2{0.1, 0.05, 0.0};
  EXPECT_TRUE(would_start());
  settings_.initial_pose = Pose2{500.0, 500.0, 0.0};
  EXPECT_EQ(
      finding("map").text,
      "'localization.initial_pose': 500,500 lies outside the map, which reaches from 0 to 0.15 m in x and from 0 to "
      "0.1 m in y");
  EXPECT_FALSE(would_start());
}

TEST_F(CheckConfig, AStartInTheUnknownOrInAWallIsAWarning) {
  const auto warned = [&](const Pose2& pose, const std::string& where) {
    settings_.initial_pose = pose;
    const auto findings = check_config(settings_, "robot.yaml", "");
    return std::any_of(findings.begin(), findings.end(), [&](const Finding& one) {
      return one.level == Level::kWarning &&
             one.text.find("lies " + where + " of the map: is it right?") != std::string::npos;
    });
  };
  EXPECT_TRUE(warned({0.12, 0.07, 0.0}, "in the unknown"));
  EXPECT_TRUE(warned({0.01, 0.07, 0.0}, "on an occupied cell"));
  EXPECT_FALSE(warned({0.07, 0.07, 0.0}, ""));
  EXPECT_TRUE(would_start());
}

TEST_F(CheckConfig, AbsentDevicesAreWaitedFor) {
  EXPECT_EQ(finding("robot").level, Level::kWarning);
  EXPECT_EQ(finding("laser").text.find("/nowhere/laser is missing"), 0u) << finding("laser").text;
  EXPECT_TRUE(would_start());
}

TEST_F(CheckConfig, AFileInPlaceOfAPortIsAnError) {
  settings_.laser.port = settings_.map.file;
  EXPECT_EQ(finding("laser").text, settings_.map.file + " is not a serial port");
  EXPECT_FALSE(would_start());
}

TEST_F(CheckConfig, TellsTheRevisionsOfAStoreAndTouchesNothing) {
  EXPECT_EQ(finding("store").text, settings_.map.store + ": will be made");
  EXPECT_FALSE(fs::exists(folder_.path() / "state"));
  write_store();
  const auto before = files();
  EXPECT_EQ(finding("store").text, settings_.map.store + ": newest revision of this map 1, 1 refusal");
  EXPECT_EQ(files(), before);
}

TEST_F(CheckConfig, TellsOfRevisionsThatOnlyTheKeptPoseKnows) {
  write_store();
  KeptPose pose;
  pose.first_map = grid_hash(first_);
  pose.revision = 103;
  (void)folder_.write("state/store.pose.json", json_text(pose));
  EXPECT_EQ(finding("store").level, Level::kWarning);
  EXPECT_EQ(finding("store").text, settings_.map.store +
                                       ": its newest revision of this map is 1, and the pose that was kept is of "
                                       "revision 103: 2 to 103 are missing");
  fs::resize_file(settings_.map.store, 0);
  const auto before = files();
  EXPECT_EQ(finding("store").level, Level::kWarning);
  EXPECT_NE(finding("store").text.find("is empty: a start would set it aside"), std::string::npos);
  EXPECT_NE(finding("store").text.find(": 1 to 103 are missing"), std::string::npos) << finding("store").text;
  EXPECT_EQ(files(), before);
  fs::remove(settings_.map.store);
  EXPECT_NE(finding("store").text.find("will be made: "), std::string::npos) << finding("store").text;
  EXPECT_EQ(finding("store").level, Level::kWarning);
}

TEST_F(CheckConfig, ReadsWhatAKilledDaemonHasLeftInTheLog) {
  fs::create_directories(folder_.path() / "state");
  const std::string living = settings_.map.store;
  settings_.map.store = folder_.path() / "state/killed.sqlite";
  write_store();
  mapping::store::MapStore open{settings_.map.store, first_};  // keeps the log
  open.append_refusal({}, {});
  for (const char* part : {"", "-wal"}) fs::copy_file(settings_.map.store + part, living + part);
  settings_.map.store = living;
  EXPECT_EQ(finding("store").text, living + ": newest revision of this map 1, 2 refusals");
  EXPECT_TRUE(would_start());
}

TEST_F(CheckConfig, AForeignStoreIsNamedByItsOwnPath) {
  fs::create_directories(folder_.path() / "state");
  (void)folder_.write("state/store.sqlite", std::string(5000, 'x'));
  EXPECT_EQ(finding("store").level, Level::kWarning);
  EXPECT_EQ(finding("store").text.find(settings_.map.store + ": "), 0u) << finding("store").text;
  EXPECT_NE(finding("store").text.find("a start would set it aside"), std::string::npos) << finding("store").text;
}

TEST_F(CheckConfig, AStoreWhoseFolderCannotBeIsAnErrorWithTheCure) {
  settings_.map.store = settings_.map.file + "/store.sqlite";
  EXPECT_EQ(finding("store").level, Level::kError);
  EXPECT_NE(finding("store").text.find("--set map.store=FILE"), std::string::npos) << finding("store").text;
  EXPECT_FALSE(would_start());
  EXPECT_THROW(make_state_folders(settings_, "robot.yaml"), SettingsError);
}

TEST_F(CheckConfig, TheUnitMakesTheFolderOfItsSockets) {
  if (fs::exists("/run/deltamap")) GTEST_SKIP() << "it is there";
  settings_.control.socket = "/run/deltamap/ctl.sock";
  EXPECT_EQ(finding("control").level, Level::kOk);
  EXPECT_EQ(finding("control").text, "/run/deltamap/ctl.sock: as a service; the unit makes /run/deltamap");
}

TEST_F(CheckConfig, IsOfOneMindWithTheStartOnPlacesThatCannotBe) {
  settings_.map.newest = folder_.path() / "not/made/yet.txt";
  EXPECT_EQ(finding("newest").level, Level::kError) << finding("newest").text;
  settings_.map.newest.clear();

  settings_.recording.file = folder_.path() / "run.pcapng";
  EXPECT_EQ(finding("recording").level, Level::kOk);
  fs::create_directory(folder_.path() / "run.previous.pcapng");
  EXPECT_EQ(finding("recording").level, Level::kError) << finding("recording").text;
  settings_.recording.file.clear();

  settings_.incidents.folder = folder_.path() / "made/later";
  EXPECT_EQ(finding("incidents").level, Level::kOk);
  std::ofstream(folder_.path() / "file") << "x";
  settings_.incidents.folder = folder_.path() / "file/incidents";
  EXPECT_EQ(finding("incidents").level, Level::kWarning) << finding("incidents").text;
  settings_.incidents.folder = folder_.path() / "taken";
  fs::create_directory(settings_.incidents.folder);
  const auto lock = lock_of_folder(settings_.incidents.folder);
  EXPECT_EQ(finding("incidents").level, Level::kError) << finding("incidents").text;
  settings_.incidents.folder.clear();

  settings_.control.socket = folder_.path() / std::string(150, 's');
  EXPECT_EQ(finding("control").level, Level::kWarning) << "a start has no socket";
  EXPECT_NE(finding("control").text.find("File name too long"), std::string::npos) << finding("control").text;
  settings_.control.socket.clear();

  write_store();
  EXPECT_EQ(finding("store").level, Level::kOk);
  fs::create_directory(settings_.map.store + ".lock");
  EXPECT_EQ(finding("store").level, Level::kError) << finding("store").text;
}

TEST_F(CheckConfig, ADaemonThatListensAndDoesNotAnswerIsAnErrorToo) {
  settings_.control.socket = folder_.path() / "ctl";
  boost::asio::io_context loop;
  auto silent = sockets::listening_at(loop, settings_.control.socket);
  EXPECT_EQ(finding("control").level, Level::kError);
  EXPECT_EQ(finding("control").text, settings_.control.socket + ": another daemon listens there");
  silent.close();
  EXPECT_EQ(finding("control").level, Level::kOk) << "left by one that was killed: it is replaced";
}

TEST_F(CheckConfig, AStoreOfAnotherFirstMapIsAWarning) {
  write_store();
  first_.set({0, 1}, CellState::kFree);
  write_grid(first_, settings_.map.file);
  EXPECT_EQ(finding("store").level, Level::kWarning);
  EXPECT_EQ(finding("store").text, settings_.map.store +
                                       ": holds 1 revision of another first map and none of this one: begins with "
                                       "the first map");
  EXPECT_TRUE(would_start());
}

TEST_F(CheckConfig, APipeInPlaceOfTheMapIsNotWaitedFor) {
  fs::remove(folder_.path() / "hall.pgm");
  ASSERT_EQ(mkfifo((folder_.path() / "hall.pgm").c_str(), 0600), 0);
  EXPECT_EQ(finding("map").text, (folder_.path() / "hall.pgm").string() + ": is no plain file");
  fs::remove(settings_.map.file);
  ASSERT_EQ(mkfifo(settings_.map.file.c_str(), 0600), 0);
  EXPECT_EQ(finding("map").text, settings_.map.file + ": is no plain file");
}

TEST(ServiceSettings, NameWhatTheUnitWouldKeepFromThem) {
  Settings settings;
  settings.map.file = "/home/me/maps/../m0.yaml";
  settings.map.store = "/srv/robot/store.sqlite";
  settings.map.newest = "/var/lib/deltamap/map.yaml";
  settings.recording.file = "/var/lib/deltamap/../elsewhere/bytes.pcapng";
  settings.control.socket = "/run/deltamap/ctl.sock";
  settings.poses.socket = "";
  const std::vector<Finding> findings = what_the_service_may_not(settings);
  ASSERT_EQ(findings.size(), 3U);
  EXPECT_EQ(
      findings[0].text,
      "'map.file' /home/me/maps/../m0.yaml: deltamap.service does not see what lies in /home, /root and /run/user");
  EXPECT_EQ(findings[1].text,
            "'map.store' /srv/robot/store.sqlite: deltamap.service may write to /var/lib/deltamap and "
            "/run/deltamap alone");
  EXPECT_NE(findings[2].text.find("'recording.file'"), std::string::npos);
}

TEST(ServiceSettings, NameWhatTheUnitHidesAndTheDriversThatItForbids) {
  Settings settings;
  settings.map.file = "/var/tmp/m0.yaml";
  settings.dashboard.token_file = "/root/token";
  settings.robot.port = "/dev/null";
  const std::vector<Finding> findings = what_the_service_may_not(settings);
  ASSERT_EQ(findings.size(), 3U);
  EXPECT_EQ(findings[0].text, "'map.file' /var/tmp/m0.yaml: deltamap.service has a /tmp and a /var/tmp of its own");
  EXPECT_EQ(findings[1].text.find("'dashboard.token_file' /root/token: "), 0u) << findings[1].text;
  EXPECT_EQ(findings[2].text,
            "'robot.port' /dev/null: deltamap.service needs 'DeviceAllow=char-mem rw' (sudo systemctl edit deltamap)");
}

TEST_F(CheckConfig, AnOutFolderThatHoldsTheMapIsAnError) {
  settings_.map.file = folder_.path() / "map.yaml";
  write_grid(first_, settings_.map.file);
  EXPECT_TRUE(has_error(check_config(settings_, "robot.yaml", folder_.path())));
  EXPECT_FALSE(has_error(check_config(settings_, "robot.yaml", folder_.path() / "run")));
}

TEST_F(CheckConfig, AnOutFolderThatHoldsTheMapsPictureByAnotherNameIsAnError) {
  EXPECT_FALSE(has_error(check_config(settings_, "robot.yaml", folder_.path())));
  fs::rename(folder_.path() / "hall.pgm", folder_.path() / "map.pgm");
  (void)folder_.write("hall.yaml", yaml_of(first_, "map.pgm"));  // as map_saver names it
  const std::vector<Finding> findings = check_config(settings_, "robot.yaml", folder_.path());
  EXPECT_TRUE(has_error(findings));
  EXPECT_NE(text_of(findings).find("map.pgm: --out would overwrite it; give another folder"), std::string::npos)
      << text_of(findings);
}

TEST_F(CheckConfig, TellsWhetherItWouldDrive) {
  EXPECT_EQ(finding("drive").text, "off: it never moves the robot");
  settings_.navigation.mode = navigation::DriveMode::kWander;
  EXPECT_EQ(finding("drive").text, "wander: the switch is unknown: it would stand");
  fs::create_directories(folder_.path() / "state");
  const DrivePlace place = drive_place(settings_.map.store, settings_.robot.port);
  EXPECT_EQ(KeptDrive{place}.keep(KeptDrive::DriveSwitch::kOn, Timestamp{}), "");
  EXPECT_EQ(finding("drive").text, "wander: the switch is on: it would drive");
  (void)folder_.write(place.file, "not a switch");
  EXPECT_EQ(finding("drive").level, Level::kWarning);
}

TEST_F(CheckConfig, SumsUpInOneLine) {
  const std::string text = text_of(check_config(settings_, "robot.yaml", ""));
  EXPECT_NE(text.find("warning  robot     /nowhere/robot is missing"), std::string::npos) << text;
  EXPECT_TRUE(text.ends_with("\nit would start\n")) << text;
}

TEST_F(CheckConfig, TellsTheMemoryThatARunNeedsAgainstWhatThereIs) {
  EXPECT_EQ(finding("memory").level, Level::kOk);
  EXPECT_EQ(finding("memory").text.find("about 24 MB"), 0u) << finding("memory").text;
  settings_.map.file = folder_.path() / "missing.yaml";
  EXPECT_EQ(finding("memory").text, "nothing was found");
}

TEST_F(CheckConfig, OfSettingsWithMistakesTheRestIsLookedAt) {
  const auto findings_for = [&](const std::string& yaml) {
    return text_of(check_what_is_read(look_at_settings(folder_.write("robot.yaml", yaml), {}), "robot.yaml"));
  };
  const std::string good = "map: {file: " + settings_.map.file + "}\nlaser: {port: /nowhere/laser}\n";
  const std::string text = findings_for(good + "robot: {port: [1], sonar: x}\n");
  EXPECT_EQ(text.find("error    settings  robot.yaml: 2 mistakes: see standard error\nok       map       "), 0u)
      << text;
  EXPECT_NE(text.find("\nok       memory    about 24 MB"), std::string::npos) << text;
  EXPECT_NE(text.find("\nwarning  laser     /nowhere/laser is missing"), std::string::npos) << text;
  EXPECT_EQ(text.find(" robot  "), std::string::npos) << "its port is not known: " << text;
  EXPECT_TRUE(text.ends_with("\nit would not start, or not work: see each error\n")) << text;
  const std::string half = findings_for(good + "robot: {sonar: \"x}\n");
  EXPECT_NE(half.find("\nok       memory    about 24 MB"), std::string::npos) << half;
  EXPECT_EQ(half.find(" robot  "), std::string::npos) << "its port may stand where nothing could be read: " << half;
}

TEST_F(CheckConfig, AStartMakesTheFoldersThatAreMissing) {
  settings_.recording.file = folder_.path() / "recordings/run.pcapng";
  settings_.control.socket = folder_.path() / "sockets/ctl.sock";
  make_state_folders(settings_, "robot.yaml");
  for (const char* name : {"state", "recordings", "sockets"}) EXPECT_TRUE(fs::is_directory(folder_.path() / name));
  settings_.control.socket = settings_.map.file + "/ctl.sock";
  EXPECT_NO_THROW(make_state_folders(settings_, "robot.yaml")) << "a daemon without ctl does its work";
}

TEST_F(CheckConfig, APageThatCannotBeServedIsAWarning) {
  const dashboard::Server other{{.answer = {}, .open = {}}};
  settings_.dashboard.port = other.port();
  EXPECT_EQ(finding("page").level, Level::kWarning);
  EXPECT_EQ(finding("page").text,
            other.place() + ": cannot listen: Address already in use: a start would go on without it");
  settings_.dashboard.token_file = folder_.path() / "missing";
  EXPECT_NE(finding("page").text.find("missing: no token: "), std::string::npos) << finding("page").text;
  EXPECT_TRUE(would_start());
}

TEST_F(CheckConfig, ALogBeginsWithWhatRuns) {
  const auto lines = start_banner(settings_, "robot.yaml", first_.geometry(), 12);
  EXPECT_EQ(lines[0], "deltamapd " + version_text());
  EXPECT_EQ(lines[1].find("settings: file=robot.yaml changed=4 fingerprint="), 0u) << lines[1];
  EXPECT_EQ(lines[2], "map: file=" + settings_.map.file + " size=3 x 2 cells of 0.05 m");
  EXPECT_EQ(lines[3], "store: file=" + settings_.map.store + " revision=12");
  EXPECT_EQ(lines[4], "ports: robot=/nowhere/robot laser=/nowhere/laser laser_baud=38400");
  EXPECT_EQ(lines[5], "drive: mode=off");
}

}  // namespace
}  // namespace deltamap::daemon
