// SPDX-License-Identifier: Apache-2.0
#include "daemon/live/dashboard_desk.hpp"

#include <algorithm>

#include "daemon/control/request.hpp"
#include "daemon/control/status_report.hpp"
#include "daemon/dashboard/access.hpp"
#include "daemon/live/incident_answers.hpp"
#include "daemon/live/live_messages.hpp"
#include "daemon/live/metrics_text.hpp"
#include "daemon/live/page_answers.hpp"
#include "daemon/outputs/bay_note.hpp"
#include "daemon/outputs/site_json.hpp"
#include "daemon/outputs/thing_note.hpp"
#include "daemon/outputs/zone_note.hpp"
#include "daemon/system/service.hpp"
#include "drivers/port/port_clock.hpp"

namespace deltamap::daemon {
namespace {

using dashboard::Answer;
using dashboard::Request;
using drivers::port::port_clock_now;

constexpr double kScanPeriod_s = 0.19;    // with a look every 0.1 s: five scans a second at most
constexpr double kStoredPeriod_s = 0.99;  // with a look every 0.1 s: once a second
constexpr double kStatusPeriod_s = 0.99;  // with a look every 0.1 s: once a second
constexpr const char* kJson = "application/json";

}  // namespace

DashboardDesk::DashboardDesk(const Settings& settings, const StartMap& start, const Telemetry& telemetry,
                             const GoodsBoards& goods, PageControl control)
    : settings_{settings},
      control_{std::move(control)},
      board_{start.map, start.revision},
      history_{settings.map.store},
      telemetry_{telemetry},
      goods_{goods},
      began_{port_clock_now()},
      server_{
          {.address = settings.dashboard.address,
           .port = settings.dashboard.port,
           .descriptor = service::handed_over_socket("page"),
           .guard = {.token = dashboard::token_in(settings.dashboard.token_file),
                     .takes_commands = settings.dashboard.control},
           .answer = [this](const Request& request) { return answer(request); },
           .open = [this] { return std::make_unique<LiveStream>(news_, board_); },
           .command =
               [this](const Request& request, dashboard::Reply reply) {
                 take_command(control_, !settings_.dashboard.token_file.empty(), request, std::move(reply));
               },
           .converse =
               [this] { return std::make_unique<HandDrive>(++drivers_, control_.hand, telemetry_, &port_clock_now); },
           .is_stop = [](const std::string& body) { return control::is_stop(body); },
           .busy_answer = refused_command(503, "too many commands wait already: try again"),
           .late_answer = refused_command(504, "not answered yet: the log will say what became of it"),
           .refresh = [this] { refresh(); },
           .watched = [this](bool is_watched) { watched(is_watched); }}} {
  news_.hello.set(hello_message(settings_));
}

std::string DashboardDesk::url() const { return "http://" + server_.place() + "/"; }

void DashboardDesk::watch(const WatchedStages& stages) {
  board_.set_figures([this, stages] { return figures_of(stages, telemetry_); });
}

Answer DashboardDesk::answer(const Request& request) {
  const std::string& path = request.path;
  if (path == "/") return page_file("index.html");
  if (path.starts_with("/page/")) return page_file(std::string_view(path).substr(6));
  if (path == "/api/status") return {.type = kJson, .body = status_json() + "\n"};
  if (path == "/api/history") return {.type = kJson, .body = history_json(board_) + "\n"};
  if (path == "/api/things") return {.type = kJson, .body = json_of(*goods_.things.newest()) + "\n"};
  if (path == "/api/zones") return {.type = kJson, .body = json_of(goods_.site.newest()->zones) + "\n"};
  if (path == "/api/site") return {.type = kJson, .body = json_of(*goods_.site.newest(), settings_) + "\n"};
  if (path == "/api/bays")
    return {.type = kJson, .body = json_of(*goods_.bays.newest(), *goods_.things.newest(), port_clock_now()) + "\n"};
  if (path == "/api/scan") return newest_scan();
  if (path.starts_with("/api/incidents")) return incidents_answer(settings_.incidents.folder, path);
  if (path.starts_with("/api/revision/")) return history_.answer(path);
  for (const char* form : {"png", "yaml", "pgm"}) {
    if (path == std::string("/api/map.") + form) return map_answer(board_.map(), form);
  }
  if (path == "/metrics") {
    return {.type = "text/plain; version=0.0.4; charset=utf-8", .body = metrics_text(telemetry_, since_start_s())};
  }
  return page_file(path);  // a path without a leading '/' is the name of no file
}

/// The newest scan of the board; about a second old while nobody views the page.
Answer DashboardDesk::newest_scan() const {
  LiveScan scan;
  if (!board_.fetch(scan)) return {.status = 404, .body = "no scan has come yet\n"};
  return {.type = kJson, .body = scan_json(scan) + "\n"};
}

std::string DashboardDesk::status_json() const {
  return control::status_json_line(telemetry_, settings_, since_start_s());
}

double DashboardDesk::since_start_s() const { return seconds(port_clock_now() - began_); }

void DashboardDesk::refresh() {
  const Timestamp now = port_clock_now();
  refresh_scan(now);
  refresh_stored(now);
  if (auto transients = board_.transients(); transients != transients_ || news_.transient.number == 0) {
    transients_ = std::move(transients);
    news_.transient.set(transient_message(transients_.get()));
  }
  if (!is_due(status_sent_, now, kStatusPeriod_s)) return;
  status_sent_ = now;
  news_.status.set(status_message(status_json()));
}

void DashboardDesk::refresh_scan(Timestamp now) {
  if (!board_.fetch(scan_)) return;
  news_.pose.set(pose_message(scan_, telemetry_, settings_.mapping.enabled));
  if (!is_due(scan_sent_, now, kScanPeriod_s)) return;
  scan_sent_ = now;
  news_.scan.set(scan_message(scan_), true);
  if (scan_.particles.empty() && !has_particles_) return;
  has_particles_ = !scan_.particles.empty();
  news_.particles.set(particles_message(scan_), true);
}

void DashboardDesk::refresh_stored(Timestamp now) {
  if (!is_due(stored_sent_, now, kStoredPeriod_s)) return;
  mapping::StoredScans stored = board_.stored();
  if (stored == stored_ && news_.stored.number > 0) return;
  stored_ = std::move(stored);
  stored_sent_ = now;
  news_.stored.set(stored_message(stored_), true);
}

/// With nobody viewing, no scan is kept for the page's sake.
void DashboardDesk::watched(bool is_watched) {
  board_.watch(is_watched);
  if (is_watched) return;
  stored_ = {};
  news_.stored.set(stored_message(stored_), true);
}

std::unique_ptr<DashboardDesk> begun_dashboard(const Settings& settings, const StartMap& start,
                                               const Telemetry& telemetry, const GoodsBoards& goods,
                                               PageControl control, const std::function<void(const std::string&)>& log,
                                               const std::function<void(const std::string&)>& warn) {
  if (settings.dashboard.port == 0) return nullptr;
  try {
    auto desk = std::make_unique<DashboardDesk>(settings, start, telemetry, goods, std::move(control));
    log("live page: " + desk->url());
    return desk;
  } catch (const std::exception& error) {
    warn(std::string("no live page in this run: ") + error.what());
    return nullptr;
  }
}

}  // namespace deltamap::daemon
