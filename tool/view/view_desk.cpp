// SPDX-License-Identifier: Apache-2.0
#include "tool/view/view_desk.hpp"

#include <charconv>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "daemon/live/live_messages.hpp"
#include "daemon/live/page_answers.hpp"
#include "daemon/live/pose_line.hpp"
#include "drivers/port/port_clock.hpp"
#include "localization/particles/particle_sample.hpp"

namespace deltamap::tool {
namespace {

using daemon::dashboard::Answer;
using daemon::dashboard::Request;
using Json = nlohmann::ordered_json;

constexpr daemon::LiveBoard::Kept kWholeRun{.samples = 7 * 86'400, .changes = 20'000};
constexpr double kTellPeriod_s = 0.99;    // the page takes longer silence for a lost connection
constexpr Duration kRounding{1'000'000};  // of a time as text
constexpr double kMostUnix_s = 9e9;
constexpr double kLastingPeriod_s = 1.0;
constexpr std::size_t kParticlesKept = 64;  // of each scan: a day has a million scans
constexpr const char* kJson = "application/json";

/// "time=1764000000.25"
std::optional<Timestamp> time_in(std::string_view query) {
  constexpr std::string_view kName = "time=";
  if (!query.starts_with(kName)) return std::nullopt;
  query.remove_prefix(kName.size());
  double time_s = 0.0;
  const auto [end, error] = std::from_chars(query.data(), query.data() + query.size(), time_s);
  if (error != std::errc{} || end != query.data() + query.size()) return std::nullopt;
  if (!(std::abs(time_s) <= kMostUnix_s)) return std::nullopt;
  return timestamp_from_ns(static_cast<std::int64_t>(std::llround(time_s * 1e6)) * 1000);
}

}  // namespace

ViewDesk::ViewDesk(ViewedRun run, std::uint16_t port)
    : run_{std::move(run)},
      board_{run_.map, run_.revision, kWholeRun},
      history_{run_.store},
      moments_{std::filesystem::temp_directory_path()},
      things_{run_.things},
      server_{{.port = port,
               .guard = {},
               .answer = [this](const Request& request) { return answer(request); },
               .open = [this] { return std::make_unique<daemon::LiveStream>(news_, board_); },
               .refresh = [this] { refresh(); }}} {
  run_.settings.dashboard.control = false;  // whatever the run itself allowed
  news_.hello.set(daemon::hello_message(
      run_.settings, daemon::RunName{run_.kind, run_.name, run_.first_revision, !run_.store.empty()}));
}

void ViewDesk::show(const daemon::LocalizationRow& row) {
  constexpr double kUnknown_s = std::numeric_limits<double>::quiet_NaN();
  board_.show({}, row, kUnknown_s);
  events_.observe(row);
  moments_.add(row.time, {daemon::pose_line({row, kUnknown_s, std::nullopt})});
}

void ViewDesk::show(const daemon::ReplayedScan& replayed) {
  const auto& [tracked, row, cost_s, particles, awareness] = replayed;
  board_.show(tracked, row, cost_s);
  events_.observe(row);
  daemon::LiveScan scan{
      .number = row.number, .row = row, .latency_s = cost_s, .beams = daemon::beams_of(tracked), .particles = {}};
  if (particles != nullptr) scan.particles = localization::particles::sampled_poses(*particles, kParticlesKept);
  keep_lasting(row.time, awareness);
  moments_.add(row.time, {daemon::pose_line({row, cost_s, std::nullopt}), daemon::scan_message(scan),
                          daemon::particles_message(scan)});
}

/// What is not map yet, and the scans that are kept for it: once a second at most, as a live page has them.
void ViewDesk::keep_lasting(Timestamp now, const mapping::StoreScan& awareness) {
  const bool is_first = !lasting_kept_;
  if (!is_first && !daemon::is_due(*lasting_kept_, now, kLastingPeriod_s)) return;
  lasting_kept_ = now;
  mapping::StoredScans stored = awareness.stored();
  if (!is_first && stored == stored_ && awareness.transients() == transients_) return;
  stored_ = std::move(stored);
  transients_ = awareness.transients();
  moments_.add_lasting({daemon::stored_message(stored_), daemon::transient_message(transients_.get())});
}

void ViewDesk::show(const MapRevision* revision, const daemon::ChangeNote& note) {
  board_.show(revision, note);
  events_.observe(note);
}

void ViewDesk::tell_progress(double done) {
  const std::scoped_lock lock{mutex_};
  done_ = done;
}

void ViewDesk::tell_complete(const std::string& note) {
  const std::scoped_lock lock{mutex_};
  done_ = 1.0;
  is_complete_ = true;
  note_ = note;
}

Answer ViewDesk::answer(const Request& request) {
  const std::string& path = request.path;
  if (path == "/") return daemon::page_file("index.html");
  if (path.starts_with("/page/")) return daemon::page_file(std::string_view(path).substr(6));
  if (path == "/api/moment") return moment(request.query);
  if (path == "/api/things") return things(request.query);
  if (path == "/api/events") return {.type = kJson, .body = events_.json() + "\n"};
  if (path == "/api/history") return {.type = kJson, .body = daemon::history_json(board_) + "\n"};
  if (path.starts_with("/api/revision/")) return revision(path);
  for (const char* form : {"png", "yaml", "pgm"}) {
    if (path == std::string("/api/map.") + form) return daemon::map_answer(board_.map(), form);
  }
  return daemon::page_file(path);  // has no '/' in front: never found
}

Answer ViewDesk::moment(const std::string& query) const {
  const auto time = time_in(query);
  if (!time) return {.status = 400, .body = "/api/moment?time=T needs a time, Unix s\n"};
  auto messages = moments_.at(*time + kRounding);
  if (!messages) return {.status = 404, .body = "the run has no scan\n"};
  return {.type = "application/octet-stream", .body = *std::move(messages)};
}

Answer ViewDesk::things(const std::string& query) {
  const auto time = time_in(query);
  if (!time) return {.status = 400, .body = "/api/things?time=T needs a time, Unix s\n"};
  return {.type = kJson, .body = things_.at(*time + kRounding) + "\n"};
}

Answer ViewDesk::revision(const std::string& path) {
  const auto wanted = daemon::revision_path(path);
  if (!wanted || run_.first_revision == 0) return history_.answer(path);
  if (wanted->number < run_.first_revision) {
    return {.status = 404, .body = "revision " + std::to_string(wanted->number) + " is of a run before\n"};
  }
  const std::uint32_t in_store = wanted->number - run_.first_revision;
  return history_.answer("/api/revision/" + std::to_string(in_store) + "/" + std::string(wanted->part));
}

std::string ViewDesk::run_message() const {
  const MomentFile::Span span = moments_.span();
  const std::scoped_lock lock{mutex_};
  Json json;
  json["type"] = "run";
  json["complete"] = is_complete_;
  json["done"] = done_;
  json["scans"] = span.scans;
  json["from"] = span.scans == 0 ? Json(nullptr) : Json(unix_seconds(span.from));
  json["to"] = span.scans == 0 ? Json(nullptr) : Json(unix_seconds(span.to));
  json["revision"] = board_.map().revision;
  json["note"] = note_;
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

void ViewDesk::refresh() {
  const Timestamp now = drivers::port::port_clock_now();
  if (news_.run.number != 0 && !daemon::is_due(told_, now, kTellPeriod_s)) return;
  told_ = now;
  news_.run.set(run_message());
}

}  // namespace deltamap::tool
