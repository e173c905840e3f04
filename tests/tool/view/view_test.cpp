// SPDX-License-Identifier: Apache-2.0
// `deltamap view`: what the page of a finished run answers, what is read of a run's folder, and what is refused.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <thread>

#include "tests/support/bytes/live_decoding.hpp"
#include "tests/support/daemon/pipeline_fixture.hpp"
#include "tests/support/daemon/web_client.hpp"
#include "tests/support/files/source_tree.hpp"
#include "tests/support/files/tool_run.hpp"
#include "tool/view/moment_file.hpp"
#include "tool/view/run_folder.hpp"
#include "tool/view/view_desk.hpp"

namespace deltamap::tool {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using test::lines_of;
using test::WebAnswer;
using test::WebClient;

Timestamp second(std::int64_t number) { return timestamp_from_ns(number * 1'000'000'000); }

/// Each after the number of its bytes.
std::vector<std::string> messages_in(const std::string& bytes) {
  std::vector<std::string> messages;
  for (std::size_t at = 0; at < bytes.size();) {
    const std::size_t size = test::u32_at(bytes, at);
    messages.push_back(bytes.substr(at + 4, size));
    at += 4 + size;
  }
  return messages;
}

TEST(MomentFile, FindsTheNewestScanThatIsNotYounger) {
  MomentFile moments{fs::temp_directory_path()};
  EXPECT_FALSE(moments.at(second(1)));
  EXPECT_EQ(moments.span().scans, 0U);
  for (int i = 10; i < 20; i += 2)
    moments.add(second(i), {"pose " + std::to_string(i), std::string(static_cast<std::size_t>(i), '\0')});
  const auto pose_at = [&](int time) { return messages_in(moments.at(second(time)).value()).front(); };
  EXPECT_EQ(pose_at(14), "pose 14");
  EXPECT_EQ(pose_at(15), "pose 14");
  EXPECT_EQ(pose_at(99), "pose 18");
  EXPECT_EQ(pose_at(1), "pose 10") << "before the first scan: the first";
  EXPECT_EQ(messages_in(moments.at(second(18)).value()).at(1), std::string(18, '\0'));
  EXPECT_EQ(moments.span().scans, 5U);
  EXPECT_EQ(moments.span().from, second(10));
  EXPECT_EQ(moments.span().to, second(18));
}

TEST(MomentFile, WhatLastsBelongsToEveryScanFromThereOn) {
  MomentFile moments{fs::temp_directory_path()};
  moments.add(second(1), {"pose 1"});
  moments.add_lasting({"two kept", "three kept"});
  moments.add(second(2), {"pose 2"});
  moments.add(second(3), {"pose 3"});
  moments.add_lasting({});
  moments.add(second(4), {"pose 4"});
  const auto at = [&](int time) { return messages_in(moments.at(second(time)).value()); };
  EXPECT_EQ(at(1), (std::vector<std::string>{"pose 1"}));
  EXPECT_EQ(at(2), (std::vector<std::string>{"pose 2", "two kept", "three kept"}));
  EXPECT_EQ(at(3), (std::vector<std::string>{"pose 3", "two kept", "three kept"}));
  EXPECT_EQ(at(4), (std::vector<std::string>{"pose 4"}));
}

TEST(MomentFile, AFolderThatIsNotThereIsNamed) {
  try {
    const MomentFile moments{"/no/such/folder"};
    FAIL() << "must refuse";
  } catch (const std::system_error& error) {
    EXPECT_NE(std::string(error.what()).find("/no/such/folder: cannot hold the scans of the run"), std::string::npos);
  }
}

/// A short drive, replayed into a folder.
class ViewTest : public test::PipelineFixture {
 protected:
  void SetUp() override {
    settings_.recording.file.clear();
    report_ = replay("drive.pcapng", "run");
  }
  ~ViewTest() override { end(); }

  [[nodiscard]] fs::path run() const { return folder_.path() / "run"; }
  void serve(ViewedRun run) {
    desk_ = std::make_unique<ViewDesk>(std::move(run), 0);
    thread_ = std::thread{[this] { desk_->run(); }};
  }
  void end() {
    if (!thread_.joinable()) return;
    desk_->stop();
    thread_.join();
  }
  void serve_folder() {
    const RunFolder read = read_run_folder(run());
    daemon::Settings settings;
    settings.dashboard.control = true;  // as of a run that took commands
    serve({.kind = "folder",
           .name = "run",
           .settings = settings,
           .map = std::make_shared<const OccupancyGrid>(read_grid(run() / "map.yaml")),
           .revision = static_cast<std::uint32_t>(report_.changes.accepted()),
           .store = run() / "map_store.sqlite"});
    for (const daemon::ChangeNote& change : read.changes) desk_->show(nullptr, change);
    for (const daemon::LocalizationRow& row : read.rows) desk_->show(row);
    desk_->tell_complete("");
  }
  [[nodiscard]] std::uint16_t port() const {
    return static_cast<std::uint16_t>(std::stoi(desk_->url().substr(desk_->url().rfind(':') + 1)));
  }
  [[nodiscard]] WebAnswer got(const std::string& path) const { return WebClient{port()}.got(path); }
  [[nodiscard]] std::string refusal() const {
    try {
      (void)read_run_folder(run());
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  }
  /// Replaces line `number`, from 1, of a file of the run.
  void replace_line(const std::string& file, int number, const std::string& text) const {
    std::istringstream in{test::content_of(run() / file)};
    std::string all, line;
    for (int i = 1; std::getline(in, line); ++i) all += (i == number ? text : line) + "\n";
    (void)folder_.write("run/" + file, all);
  }

  daemon::RunReport report_;
  std::unique_ptr<ViewDesk> desk_;
  std::thread thread_;
};

TEST_F(ViewTest, TellsWhatOneMayJumpTo) {
  serve_folder();
  const auto events = nlohmann::json::parse(got("/api/events").body);
  const auto changes =
      std::count_if(events.begin(), events.end(), [](const auto& one) { return one["kind"] == "change"; });
  EXPECT_EQ(changes, static_cast<std::ptrdiff_t>(report_.changes.accepted()));
  EXPECT_GT(changes, 0);
}

TEST_F(ViewTest, AFolderIsReadAsTheRunWroteIt) {
  const RunFolder read = read_run_folder(run());
  EXPECT_EQ(read.notes, std::vector<std::string>{});
  ASSERT_EQ(read.rows.size(), report_.scans.localized);
  std::string log = daemon::csv_header();
  for (const daemon::LocalizationRow& row : read.rows) log += daemon::csv_line(row);
  EXPECT_EQ(test::first_difference(log, test::content_of(run() / "localization.csv")), "");
  ASSERT_EQ(read.changes.size(), report_.changes.accepted() + report_.changes.refused());
  std::string changes;
  for (const daemon::ChangeNote& change : read.changes) changes += daemon::json_line(change);
  EXPECT_EQ(test::first_difference(changes, test::content_of(run() / "changes.jsonl")), "");
  EXPECT_EQ(read.settings.localizer.particles.max, 200) << "as report.json has it";
}

TEST_F(ViewTest, ARunWhoseStampsStepBackIsReadInTheirOrderAndSaysSo) {
  const RunFolder whole = read_run_folder(run());
  const std::string log = test::content_of(run() / "localization.csv");
  std::vector<std::string> lines;
  std::istringstream in{log};
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  replace_line("localization.csv", 40, lines[40]);
  replace_line("localization.csv", 41, lines[39]);
  const RunFolder read = read_run_folder(run());
  ASSERT_EQ(read.rows.size(), whole.rows.size());
  for (std::size_t i = 0; i < read.rows.size(); ++i) EXPECT_EQ(read.rows[i].number, whole.rows[i].number) << i;
  ASSERT_EQ(read.notes.size(), 1U);
  EXPECT_NE(read.notes[0].find("localization.csv:41: the time steps back; scans are shown in the order of their times"),
            std::string::npos)
      << read.notes[0];
}

TEST_F(ViewTest, AMomentHoldsThePoseOfItsTime) {
  serve_folder();
  const RunFolder read = read_run_folder(run());
  const daemon::LocalizationRow& wanted = read.rows.at(100);
  const double time_s = unix_seconds(wanted.time);
  char address[64];
  (void)std::snprintf(address, sizeof address, "/api/moment?time=%.4f", time_s + 0.01);
  const auto messages = messages_in(got(address).body);
  ASSERT_EQ(messages.size(), 1U) << "a folder has no scans";
  const Json pose = Json::parse(messages.front());
  EXPECT_EQ(pose["scan"], wanted.number);
  EXPECT_EQ(pose["x_m"], wanted.map_from_robot.x);
  EXPECT_EQ(pose["gate"], nullptr);
  EXPECT_TRUE(pose["latency_ms"].is_null()) << "no log holds it";
  for (const char* bad : {"/api/moment", "/api/moment?time=", "/api/moment?time=soon", "/api/moment?time=nan",
                          "/api/moment?time=1e300", "/api/moment?at=5"}) {
    EXPECT_EQ(got(bad).status, 400) << bad;
  }
}

TEST_F(ViewTest, TheStreamTellsOfTheRunAndOfAllThatChanged) {
  serve_folder();
  WebClient viewer{port()};
  ASSERT_EQ(viewer.upgraded().status, 101);
  Json hello, told, changes;
  bool has_map = false;
  while (changes.is_null()) {
    const auto frame = viewer.frame();
    ASSERT_TRUE(frame);
    if (frame->opcode != 1) continue;
    const Json message = Json::parse(frame->payload);
    if (message["type"] == "hello") hello = message;
    if (message["type"] == "run") told = message;
    if (message["type"] == "map") has_map = true;
    if (message["type"] == "changes") changes = message;
  }
  EXPECT_EQ(hello["run"], (Json{{"kind", "folder"}, {"name", "run"}, {"first_revision", 0}, {"has_history", true}}));
  EXPECT_EQ(hello["control"], nullptr);
  EXPECT_EQ(told["complete"], true);
  EXPECT_EQ(told["scans"], report_.scans.localized);
  EXPECT_LT(told["from"], told["to"]);
  EXPECT_TRUE(has_map);
  EXPECT_EQ(changes["changes"].size(), report_.changes.accepted() + report_.changes.refused());
}

TEST_F(ViewTest, RevisionsComeFromTheRunAndNothingIsCommanded) {
  serve_folder();
  EXPECT_EQ(got("/").status, 200);
  EXPECT_EQ(got("/page/run.js").status, 200);
  EXPECT_EQ(got("/api/revision/0/cells").status, 200);
  EXPECT_EQ(got("/api/revision/1/changes").status, 200);
  EXPECT_EQ(got("/api/revision/99/cells").status, 404);
  EXPECT_EQ(got("/api/status").status, 404);
  EXPECT_EQ(WebClient{port()}.posted("/api/command", R"({"command":"pause"})").status, 403);
  EXPECT_EQ(WebClient{port()}.got("/", "Host: elsewhere.example\r\n").status, 421);
}

TEST_F(ViewTest, ARunThatBeganLaterCountsItsRevisionsFromThere) {
  serve({.kind = "folder",
         .map = std::make_shared<const OccupancyGrid>(read_grid(run() / "map.yaml")),
         .revision = 6,
         .first_revision = 5,
         .store = run() / "map_store.sqlite"});
  EXPECT_EQ(got("/api/revision/4/cells").status, 404);
  EXPECT_EQ(got("/api/revision/5/cells").status, 200);
  EXPECT_EQ(Json::parse(got("/api/revision/6/changes").body)["cells"].size(),
            report_.changes.revisions().front().added + report_.changes.revisions().front().freed +
                report_.changes.revisions().front().forgotten);
}

TEST_F(ViewTest, AReplayIsWatchedScanByScanAndComesToTheSameFiles) {
  daemon::ReplayJob job;
  job.recording = folder_.path() / "drive.pcapng";
  job.map = folder_.path() / "room.yaml";
  job.settings = settings_;
  job.out = folder_.path() / "watched";
  serve({.kind = "recording", .map = std::make_shared<const OccupancyGrid>(read_grid(job.map))});
  job.watch.scan = [this](const daemon::ReplayedScan& scan) { desk_->show(scan); };
  job.watch.change = [this](const MapRevision* revision, const daemon::ChangeNote& note) {
    desk_->show(revision, note);
  };
  (void)daemon::run_replay(job, [](double) { return true; });
  expect_same_files("run", "watched");
  const auto messages = messages_in(got("/api/moment?time=9000000000").body);
  ASSERT_EQ(messages.size(), 5U);
  EXPECT_EQ(test::u32_at(messages[1], 0), 3U) << "a scan, as /live sends it";
  EXPECT_GT(test::u32_at(messages[1], 4), 100U) << "of so many beams";
  EXPECT_EQ(test::u32_at(messages[2], 0), 4U) << "particles";
  EXPECT_EQ(test::u32_at(messages[3], 0), 5U) << "scans kept for the map";
  EXPECT_EQ(Json::parse(messages[4])["type"], "transient");
  std::uint32_t most_stored = 0;
  const std::vector<daemon::LocalizationRow> rows = read_run_folder(run()).rows;
  for (std::size_t i = 0; i < rows.size(); i += 5) {
    const std::string time = std::to_string(unix_seconds(rows[i].time));
    const auto of_then = messages_in(got("/api/moment?time=" + time).body);
    ASSERT_EQ(of_then.size(), 5U) << "from the first scan on: a page that is scrubbed back shows nothing of later";
    most_stored = std::max(most_stored, test::u32_at(of_then[3], 4));
  }
  EXPECT_GT(most_stored, 0U) << "at some time of the run";
  EXPECT_EQ(Json::parse(got("/api/history").body)["revision"], report_.changes.accepted());
}

TEST_F(ViewTest, ALineThatIsCutIsTheEndOfItsFile) {
  const std::string log = test::content_of(run() / "localization.csv");
  (void)folder_.write("run/localization.csv", log.substr(0, log.size() - 20));
  const RunFolder read = read_run_folder(run());
  EXPECT_EQ(read.rows.size() + 1, report_.scans.localized);
  EXPECT_EQ(read.notes, std::vector<std::string>{(run() / "localization.csv").string() + ": its last line is cut"});
}

TEST_F(ViewTest, WhatIsNoLogIsRefusedByFileAndLine) {
  const std::string log = (run() / "localization.csv").string(), whole = test::content_of(log);
  replace_line("localization.csv", 3, "1764000000.000000000,3");
  EXPECT_EQ(refusal().substr(0, log.size() + 12), log + ":3: 2 values") << refusal();
  (void)folder_.write("run/localization.csv", whole);
  replace_line("localization.csv", 4, "soon" + whole.substr(whole.find(',')));
  EXPECT_TRUE(refusal().starts_with(log + ":4: ")) << refusal();
  (void)folder_.write("run/localization.csv", "a,b\n1,2\n");
  EXPECT_TRUE(refusal().starts_with(log + ":1: is no log of a localizer")) << refusal();
  (void)folder_.write("run/localization.csv", daemon::csv_header());
  EXPECT_EQ(refusal(), log + ": holds no scan");
  (void)folder_.write("run/localization.csv", "");
  EXPECT_TRUE(refusal().starts_with(log + ":1: has no line")) << refusal();
  (void)folder_.write("run/localization.csv", whole);
  (void)folder_.write("run/changes.jsonl", "{}\n");
  EXPECT_EQ(refusal(), (run() / "changes.jsonl").string() + ":1: is no line of changes.jsonl");
  fs::remove(run() / "map.yaml");
  EXPECT_EQ(refusal(), run().string() + ": is no folder of a run: it has no map.yaml");
}

TEST_F(ViewTest, BadInputIsOneLineAndExitCodeOne) {
  const auto refused = [&](const std::vector<std::string>& words) {
    std::vector<std::string> all{"view"};
    all.insert(all.end(), words.begin(), words.end());
    const test::ToolRun told = test::run_deltamap(all);
    EXPECT_EQ(told.exit_code, 1) << told.errors;
    EXPECT_EQ(told.output, "") << "no address";
    const std::string warning = "deltamap: warning: ";  // of the room's map
    const std::string refusal =
        told.errors.starts_with(warning) ? told.errors.substr(told.errors.find('\n') + 1) : told.errors;
    EXPECT_EQ(lines_of(refusal), 1U) << told.errors;
    return refusal;
  };
  const std::string nothing = (folder_.path() / "nothing").string();
  EXPECT_EQ(refused({nothing}), "deltamap: " + nothing + ": No such file or directory\n");
  const std::string empty = (folder_.path() / "empty").string();
  fs::create_directories(empty);
  EXPECT_EQ(refused({empty}), "deltamap: " + empty + ": is no folder of a run: it has no localization.csv\n");
  const std::string recording = (folder_.path() / "drive.pcapng").string();
  EXPECT_EQ(refused({recording}), "deltamap: " + recording + ": a recording needs --map, as `deltamap replay` does\n");
  const std::vector<std::string> how{"--map", folder_.path() / "room.yaml", "--config",
                                     test::source_path("config/simulation.yaml")};
  const std::string text = folder_.write("text.pcapng", "no recording\n").string();
  EXPECT_TRUE(refused({text, how[0], how[1], how[2], how[3]}).starts_with("deltamap: " + text + ": "));
  EXPECT_EQ(test::run_deltamap({"view"}).exit_code, 2);
  EXPECT_EQ(test::run_deltamap({"view", recording, "--port", "70000"}).exit_code, 2);
}

}  // namespace
}  // namespace deltamap::tool
