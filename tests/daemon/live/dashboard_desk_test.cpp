// SPDX-License-Identifier: Apache-2.0
// The live page as a browser meets it: every endpoint's answer, and what a viewer is sent.
#include "daemon/live/dashboard_desk.hpp"

#include <gtest/gtest.h>
#include <png.h>

#include <algorithm>
#include <mutex>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>
#include <thread>

#include "core/files/grid_file.hpp"
#include "daemon/incidents/incident_list.hpp"
#include "tests/support/bytes/live_decoding.hpp"
#include "tests/support/daemon/pipeline_fixture.hpp"
#include "tests/support/daemon/web_client.hpp"
#include "tests/support/files/temporary_folder.hpp"
#include "tests/support/worlds/drawn_grid.hpp"

namespace deltamap::daemon {
namespace {

using Json = nlohmann::json;
using test::WebAnswer;
using test::WebClient;

std::uint16_t port_in(const std::string& url) {
  return static_cast<std::uint16_t>(std::stoi(url.substr(url.rfind(':') + 1)));
}

class DashboardDeskTest : public testing::Test {
 protected:
  void start() {
    desk_ = std::make_unique<DashboardDesk>(settings_, start_, telemetry_, GoodsBoards{things_, bays_, site_});
    thread_ = std::thread([this] { desk_->run(); });
  }
  ~DashboardDeskTest() override {
    if (!thread_.joinable()) return;
    desk_->stop();
    thread_.join();
  }
  [[nodiscard]] std::uint16_t port() const { return port_in(desk_->url()); }
  [[nodiscard]] WebAnswer got(const std::string& path) const { return WebClient{port()}.got(path); }
  void show_change(Cell cell) {
    MapRevision revision;
    revision.number = 1;
    revision.changes = {{cell, CellState::kFree, CellState::kOccupied}};
    revision.map = std::make_shared<const OccupancyGrid>(patched(*start_.map, revision.changes));
    ChangeNote note;
    note.phase = 4;
    note.revision = 1;
    note.added = 1;
    note.acceptance = 0.97;
    desk_->board().show(&revision, note);
  }
  void show_scan() {
    TrackedScan tracked;
    tracked.scan.beams = {{.range_m = 1.0F, .kind = BeamKind::kRange}};
    tracked.rays.resize(1);
    tracked.rays[0].end = {1.25F, 0.5F};
    LocalizationRow row;
    row.map_from_robot = {0.5, 0.25, 0.125};
    row.belief.other_share = 0.25;
    row.time = timestamp_from_ns(1'700'000'000'500'000'000);
    desk_->board().show(tracked, row, 0.001);
  }

  Settings settings_;
  StartMap start_{.map = std::make_shared<const OccupancyGrid>(test::drawn_grid({"#..", "#..", "###"}, 0.5))};
  Telemetry telemetry_;
  ThingsBoard things_;
  BaysBoard bays_;
  NewestBoard<Site> site_;
  std::unique_ptr<DashboardDesk> desk_;
  std::thread thread_;
};

TEST_F(DashboardDeskTest, ListsIncidentsAndTellsOneInWords) {
  const test::TemporaryFolder folder;
  start();
  EXPECT_EQ(got("/api/incidents").body, "{\"folder\":\"\",\"incidents\":[]}\n");
  EXPECT_EQ(got("/api/incidents/x").status, 404);
  desk_->stop();
  thread_.join();
  Incident incident;
  incident.name = "20261130T030012Z-lost";
  incident.events = {{IncidentKind::kLost, timestamp_from_ns(1'764'471'612'000'000'000), "the pose was lost"}};
  std::filesystem::create_directories(folder.path() / incident.name);
  std::ofstream(folder.path() / incident.name / kIncidentFacts) << json_text(incident);
  std::ofstream(folder.path() / incident.name / kIncidentPicture) << "a picture";
  settings_.incidents.folder = folder.path();
  start();
  const Json list = Json::parse(got("/api/incidents").body);
  ASSERT_EQ(list["incidents"].size(), 1u) << list;
  EXPECT_EQ(list["incidents"][0]["kind"], "lost");
  const WebAnswer words = got("/api/incidents/" + incident.name);
  EXPECT_EQ(words.status, 200);
  EXPECT_EQ(words.body, words_of(incident, true));
  EXPECT_EQ(list["incidents"][0]["picture"], true);
  const WebAnswer picture = got("/api/incidents/" + incident.name + "/picture.png");
  EXPECT_EQ(picture.headers.at("Content-Type"), "image/png");
  EXPECT_EQ(picture.body, "a picture");
  for (const char* elsewhere : {"/api/incidents/", "/api/incidents/x/picture.png", "/api/incidents/picture.png",
                                "/api/incidents/..", "/api/incidents/../../etc/passwd", "/api/incidentsx"})
    EXPECT_EQ(got(elsewhere).status, 404) << elsewhere;
}

TEST_F(DashboardDeskTest, ThePageAndItsFilesComeWithTheirTypes) {
  start();
  const WebAnswer page = got("/");
  EXPECT_EQ(page.status, 200);
  EXPECT_EQ(page.headers.at("Content-Type"), "text/html; charset=utf-8");
  const std::regex link{"(?:href|src)=\"(/page/[^\"]+)\""};
  int files = 0;
  for (std::sregex_iterator found{page.body.begin(), page.body.end(), link}, end; found != end; ++found, ++files) {
    const WebAnswer file = got((*found)[1]);
    EXPECT_EQ(file.status, 200) << (*found)[1];
    EXPECT_FALSE(file.body.empty());
  }
  EXPECT_GE(files, 3);
  for (const char* missing : {"/page/", "/page/../CMakeLists.txt", "/index.html", "/api", "/etc/passwd", "//", "*"}) {
    EXPECT_EQ(got(missing).status, 404) << missing;
  }
}

TEST_F(DashboardDeskTest, TheStatusIsWhatCtlStatusSays) {
  telemetry_.newest_revision.set(12);
  start();
  const WebAnswer answer = got("/api/status");
  EXPECT_EQ(answer.headers.at("Content-Type"), "application/json");
  const Json status = Json::parse(answer.body);
  EXPECT_EQ(status["newest_revision"], 12);
  EXPECT_EQ(status["state"], "no scan yet");
  EXPECT_EQ(status["ports"]["laser"], "down");
}

TEST_F(DashboardDeskTest, TheMapIsAPictureOfTheNewestRevision) {
  start();
  show_change({2, 2});
  const WebAnswer answer = got("/api/map.png");
  EXPECT_EQ(answer.headers.at("Content-Type"), "image/png");
  EXPECT_EQ(answer.headers.at("X-Deltamap-Revision"), "1");
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  ASSERT_NE(png_image_begin_read_from_memory(&image, answer.body.data(), answer.body.size()), 0);
  EXPECT_EQ(image.width, 3u);
  EXPECT_EQ(image.height, 3u);
  image.format = PNG_FORMAT_GRAY;
  std::vector<std::uint8_t> pixels(PNG_IMAGE_SIZE(image));
  ASSERT_NE(png_image_finish_read(&image, nullptr, pixels.data(), 0, nullptr), 0);
  EXPECT_LT(pixels[2], 50) << "what has changed, upper right";
  EXPECT_GT(pixels[1], 200);
}

TEST_F(DashboardDeskTest, TheMapComesInMapServersFormAndReadsBack) {
  start();
  show_change({2, 2});
  const test::TemporaryFolder folder;
  for (const char* name : {"map.yaml", "map.pgm"}) {
    const WebAnswer answer = got(std::string("/api/") + name);
    EXPECT_EQ(answer.status, 200);
    EXPECT_EQ(answer.headers.at("X-Deltamap-Revision"), "1");
    (void)folder.write(name, answer.body);
  }
  const OccupancyGrid read = read_grid(folder.path() / "map.yaml");
  EXPECT_EQ(grid_hash(read), grid_hash(*desk_->board().map().grid));
}

TEST_F(DashboardDeskTest, TheNewestScanComesWithItsPose) {
  start();
  EXPECT_EQ(got("/api/scan").status, 404);
  show_scan();
  const Json scan = Json::parse(got("/api/scan").body);
  EXPECT_EQ(scan["time"], 1'700'000'000.5);
  EXPECT_EQ(scan["pose"], (Json{{"x_m", 0.5}, {"y_m", 0.25}, {"heading_rad", 0.125}}));
  EXPECT_EQ(scan["ends_m"], Json::parse("[[1.25, 0.5]]"));
}

TEST_F(DashboardDeskTest, TheHistoryListsWhatThisRunHasChanged) {
  start();
  EXPECT_EQ(Json::parse(got("/api/history").body),
            (Json{{"revision", 0}, {"forgotten", 0}, {"changes", Json::array()}}));
  show_change({2, 2});
  const Json history = Json::parse(got("/api/history").body);
  EXPECT_EQ(history["revision"], 1);
  ASSERT_EQ(history["changes"].size(), 1u);
  EXPECT_EQ(history["changes"][0]["acceptance"], 0.97);
  EXPECT_EQ(history["changes"][0]["accepted"], true);
}

TEST_F(DashboardDeskTest, TellsOfBaysAndTheirAge) {
  start();
  EXPECT_EQ(Json::parse(got("/api/bays").body)["bays"], Json::array());
  const Polygon polygon{{1.0, 1.0}, {3.4, 1.0}, {3.4, 3.4}, {1.0, 3.4}};
  mapping::bays::BayStatus status{.state = mapping::bays::BayState::kFull, .share = 0.934, .confidence = 0.8};
  status.seen = drivers::port::port_clock_now() - std::chrono::seconds{40};
  bays_.set(std::make_shared<const BayList>(BayList{{{.id = "B4", .polygon = polygon}}, {status}}));
  mapping::things::Thing thing;
  thing.id = 12;
  thing.at = mapping::things::Outline{{2.2, 2.2}, 2.4, 2.4, 0.0, {}};
  things_.set(std::make_shared<const ThingList>(ThingList{{thing}, 0, 0}));
  const Json bay = Json::parse(got("/api/bays").body)["bays"][0];
  EXPECT_EQ(bay["bay"], "B4");
  EXPECT_EQ(bay["state"], "full");
  EXPECT_DOUBLE_EQ(bay["share"].get<double>(), 0.93);
  EXPECT_NEAR(bay["age_s"].get<double>(), 40.0, 5.0);
  EXPECT_EQ(bay["since"], nullptr);
  EXPECT_EQ(bay["things"], Json({12}));
  EXPECT_EQ(bay["polygon_m"].size(), 4u);
}

TEST_F(DashboardDeskTest, ShowsZonesAsTheirFileHasThem) {
  start();
  EXPECT_EQ(got("/api/zones").body, "{\"ok\":true,\"zones\":[]}\n");
  const Polygon polygon{{1.0, 1.0}, {3.4, 1.0}, {3.4, 3.4}};
  site_.set(std::make_shared<const Site>(
      Site{{}, {{.id = "gate", .kind = ZoneKind::kSpeedLimit, .most_speed_m_per_s = 0.3, .polygon = polygon}}}));
  const Json zone = Json::parse(got("/api/zones").body)["zones"][0];
  EXPECT_EQ(zone["zoneId"], "gate");
  EXPECT_EQ(zone["zoneType"], "SPEED_LIMIT");
  EXPECT_EQ(zone["maximumSpeed"], 0.3);
  EXPECT_EQ(zone["vertices"][1], (Json{{"x", 3.4}, {"y", 1.0}}));
}

TEST_F(DashboardDeskTest, TellsOfThings) {
  start();
  EXPECT_EQ(Json::parse(got("/api/things").body)["things"], Json::array());
  mapping::things::Thing thing;
  thing.id = 12;
  thing.at = mapping::things::Outline{{1.0, 2.0}, 2.4, 1.6, 0.0, {true, false, false, false}};
  things_.set(std::make_shared<const ThingList>(ThingList{{thing}, 7, 1}));
  const Json list = Json::parse(got("/api/things").body);
  ASSERT_EQ(list["things"].size(), 1u);
  EXPECT_EQ(list["things"][0]["thing"], 12);
  EXPECT_EQ(list["things"][0]["at"]["polygon_m"][0], (Json{2.2, 1.2}));
  EXPECT_EQ(list["things"][0]["words"], "container-like body of 2.4 × 1.6 m appeared at 1.00, 2.00");
  EXPECT_EQ(list["corrections"], 7);
}

TEST_F(DashboardDeskTest, MetricsFollowThePrometheusTextFormat) {
  telemetry_.scans.set(7);
  start();
  for (const char* unknown : {"pose_x_meters", "latency_seconds", "battery_volts"}) {
    EXPECT_EQ(got("/metrics").body.find(unknown), std::string::npos) << unknown;
  }
  telemetry_.localized.set(7);
  telemetry_.robot_up.set(true);
  telemetry_.battery_v.set(12.5);
  const WebAnswer answer = got("/metrics");
  EXPECT_EQ(answer.headers.at("Content-Type"), "text/plain; version=0.0.4; charset=utf-8");
  const std::regex comment{R"re(# (HELP deltamap_[a-z_]+ [^\n]+|TYPE deltamap_[a-z_]+ (counter|gauge)))re"};
  const std::regex sample{R"re((deltamap_[a-z_]+)(\{[a-z_]+="[^"\\\n]*"\})? -?[0-9.]+(e[-+][0-9]+)?)re"};
  std::istringstream lines(answer.body);
  std::string typed;
  std::set<std::string> seen;
  for (std::string line; std::getline(lines, line);) {
    std::smatch match;
    if (line.starts_with("#")) {
      EXPECT_TRUE(std::regex_match(line, comment)) << line;
      if (line.starts_with("# TYPE ")) typed = line.substr(7, line.rfind(' ') - 7);
      continue;
    }
    ASSERT_TRUE(std::regex_match(line, match, sample)) << line;
    EXPECT_EQ(match[1], typed) << "samples follow their type";
    EXPECT_TRUE(seen.insert(match[1].str() + match[2].str()).second) << "given twice: " << line;
    if (line.find("TYPE") == std::string::npos && typed.ends_with("_total")) {
      EXPECT_NE(answer.body.find("# TYPE " + typed + " counter\n"), std::string::npos);
    }
  }
  EXPECT_NE(answer.body.find("\ndeltamap_scans_total 7\n"), std::string::npos);
  EXPECT_NE(answer.body.find("\ndeltamap_battery_volts 12.5\n"), std::string::npos);
  EXPECT_GT(seen.size(), 30u);
}

TEST_F(DashboardDeskTest, AViewerSeesPoseScanMapAndWhatChangesInIt) {
  telemetry_.gate.set(mapping::gate::GateReason::kOpen, {});
  start();
  show_scan();
  WebClient viewer{port()};
  ASSERT_EQ(viewer.upgraded().status, 101);
  std::map<std::string, Json> told;
  std::map<std::uint32_t, std::string> bytes;
  const auto read_until = [&](const auto& is_enough) {
    while (!is_enough()) {
      const auto frame = viewer.frame();
      if (!frame) return false;
      if (frame->opcode == 2) bytes[test::u32_at(frame->payload, 0)] = frame->payload;
      if (frame->opcode == 1) {
        const Json json = Json::parse(frame->payload);
        told[json["type"]] = json;
      }
    }
    return true;
  };
  ASSERT_TRUE(
      read_until([&] { return told.count("status") > 0 && told.count("transient") > 0 && bytes.count(1) > 0; }));
  EXPECT_EQ(told["hello"]["protocol"], 1);
  EXPECT_EQ(told["pose"]["x_m"], 0.5);
  EXPECT_EQ(told["pose"]["other_hypothesis"]["share"], 0.25);
  EXPECT_EQ(told["pose"]["gate"]["open"], true);
  EXPECT_EQ(told["status"]["status"]["ok"], true);
  EXPECT_GT(told["status"]["resident_bytes"], 1'000'000);
  EXPECT_EQ(told["map"]["resolution_m"], 0.5);
  EXPECT_EQ(test::decoded_cells(bytes[1]).states.size(), 9u);
  EXPECT_EQ(test::u32_at(bytes[3], 4), 1u);
  EXPECT_EQ(test::f64_at(bytes[3], 8), 1'700'000'000.5);
  EXPECT_EQ(test::f32_at(bytes[3], 24), 0.125F);
  EXPECT_EQ(test::number_at(bytes[3], 28, 2), 125u);
  EXPECT_EQ(test::number_at(bytes[3], 30, 2), 50u);

  desk_->board().show(mapping::StoredScans{.collected = {std::make_shared<const TrackedScan>()}, .waiting = {}});
  ASSERT_TRUE(read_until([&] { return bytes.count(5) > 0 && test::u32_at(bytes[5], 4) == 1; }));
  EXPECT_EQ(bytes.count(4), 0u) << "no particles, and nothing said of them";

  bytes.clear();
  show_change({1, 1});
  ASSERT_TRUE(read_until([&] { return bytes.count(1) > 0 && told.count("changes") > 0; }));
  EXPECT_EQ(test::decoded_cells(bytes[1]).box, (CellBox{{1, 1}, {2, 2}}));
  EXPECT_EQ(told["changes"]["changes"][0]["revision"], 1);

  auto transients = std::make_shared<TransientObstacles>();
  transients->blocks = {.width = 9, .height = 9, .resolution_m = 0.25, .origin = {0.0, 0.0}};
  transients->standing = {4, 7};
  told.clear();
  EXPECT_TRUE(desk_->board().show(transients));
  ASSERT_TRUE(read_until([&] { return told.count("transient") > 0; }));
  EXPECT_EQ(told["transient"]["standing"], Json({4, 7}));
  EXPECT_EQ(told["transient"]["blocks_across"], 9);
}

}  // namespace
}  // namespace deltamap::daemon
