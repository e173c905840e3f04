// SPDX-License-Identifier: Apache-2.0
#include "daemon/incidents/incident_folder.hpp"

#include <algorithm>
#include <numeric>
#include <system_error>
#include <utility>

#include "core/files/grid_file.hpp"
#include "core/files/replace_file.hpp"
#include "core/utc_text.hpp"
#include "daemon/incidents/incident_list.hpp"

namespace deltamap::daemon {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kDraftHead = ".draft-";
constexpr std::string_view kGoneHead = ".gone-";
constexpr std::size_t kMostEvents = 50;

/// "20261130T030012Z-lost", or with a number behind it.
std::string free_name(const fs::path& parent, const IncidentEvent& event) {
  const std::string name = utc_name(event.time) + "-" + std::string(name_of(event.kind));
  std::error_code error;
  for (int number = 2;; ++number) {
    std::string tried = number == 2 ? name : name + "-" + std::to_string(number - 1);
    if (!fs::exists(parent / tried, error)) return tried;
  }
}

/// Nothing else has befallen it, and nobody has asked for it.
bool is_end(const StoredIncident& one) {
  return !one.is_pinned && one.incident.events.front().kind == IncidentKind::kDaemonEnded;
}

/// Goes last: any of its events is a person's mark, or a pose that was lost or carried away.
bool is_wanted(const StoredIncident& one) {
  return std::any_of(one.incident.events.begin(), one.incident.events.end(), [](const IncidentEvent& event) {
    return event.kind == IncidentKind::kMark || event.kind == IncidentKind::kLost ||
           event.kind == IncidentKind::kKidnapped;
  });
}

}  // namespace

IncidentFolder::IncidentFolder(const fs::path& parent, Content content) : incident_{std::move(content.incident)} {
  incident_.name = free_name(parent, incident_.events.front());
  const fs::path draft = parent / (std::string(kDraftHead) + incident_.name);
  std::error_code error;
  fs::remove_all(draft, error);
  fs::create_directories(draft, error);
  if (error) throw std::runtime_error(draft.string() + ": cannot be made: " + error.message());
  try {
    write_page(draft, incident_);  // first: what a daemon that is killed meanwhile was about to keep
    const fs::path recording = draft / kIncidentRecording;
    const fs::path part = recording.string() + ".part";
    writer_ = std::make_unique<drivers::port::ByteLogWriter>(part, content.bauds);
    content.records([this](const drivers::port::ByteRecord& record) { writer_->write(record); });
    incident_.to ? writer_->close() : writer_->flush();
    move_into_place(part, recording);
    write_grid(*content.map, draft / kIncidentMap);
    replace_file(draft / kIncidentSettings, content.settings);
    replace_file(draft / kIncidentLog, content.log);
    move_into_place(draft, parent / incident_.name);
  } catch (const std::runtime_error&) {
    writer_.reset();
    fs::remove_all(draft, error);
    throw;
  }
  folder_ = parent / incident_.name;
}

void write_page(const fs::path& folder, const Incident& incident) {
  replace_file(folder / kIncidentFacts, json_text(incident));
  std::error_code error;
  replace_file(folder / kIncidentWords, words_of(incident, fs::is_regular_file(folder / kIncidentPicture, error)));
}

void IncidentFolder::add(const IncidentEvent& event) {
  if (incident_.events.size() >= kMostEvents) return;
  incident_.events.push_back(event);
  write_page(folder_, incident_);
}

void IncidentFolder::finish(Timestamp to, const std::string& log) {
  writer_->close();
  incident_.to = to;
  replace_file(folder_ / kIncidentLog, log);
  write_page(folder_, incident_);
}

std::optional<fs::path> draft_in(const fs::path& parent) {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(parent, error)) {
    if (entry.path().filename().string().starts_with(kDraftHead)) return entry.path();
  }
  return std::nullopt;
}

void remove_drafts(const fs::path& parent) {
  std::error_code error;
  std::vector<fs::path> left;
  for (const auto& entry : fs::directory_iterator(parent, error)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(kDraftHead) || name.starts_with(kGoneHead)) left.push_back(entry.path());
  }
  for (const fs::path& folder : left) fs::remove_all(folder, error);
}

std::error_code remove_at_once(const fs::path& folder) {
  const fs::path gone = folder.parent_path() / (std::string(kGoneHead) + folder.filename().string());
  std::error_code error;
  fs::rename(folder, gone, error);
  if (!error) fs::remove_all(gone, error);
  return error;
}

std::vector<std::string> within_limits(const IncidentSettings& settings, const std::string& newest) {
  std::vector<StoredIncident> all = incidents_in(settings.folder);
  std::vector<std::string> lines;
  const auto bytes = [&all] {
    return std::accumulate(all.begin(), all.end(), std::uint64_t{0},
                           [](std::uint64_t sum, const StoredIncident& one) { return sum + one.bytes; });
  };
  for (;;) {
    const auto ends = std::count_if(all.begin(), all.end(), is_end);
    const bool too_many_ends = static_cast<std::size_t>(ends) > kMostEnds;
    const bool too_many = all.size() > settings.max_count;
    const bool too_large = static_cast<double>(bytes()) > settings.max_gigabytes * 1e9;
    const auto may_go = [&](const StoredIncident& one) {
      return !one.is_pinned && one.incident.name != newest && (!too_many_ends || is_end(one));
    };
    auto oldest =
        std::find_if(all.begin(), all.end(), [&](const StoredIncident& one) { return may_go(one) && !is_wanted(one); });
    if (oldest == all.end()) oldest = std::find_if(all.begin(), all.end(), may_go);
    if ((!too_many_ends && !too_many && !too_large) || oldest == all.end()) return lines;
    const std::error_code error = remove_at_once(oldest->folder);
    lines.push_back("incident " + oldest->incident.name + (error ? " cannot be removed: " + error.message() : " goes") +
                    ": there are more than " +
                    (too_many_ends ? std::to_string(kMostEnds) + " ends of the daemon"
                     : too_many    ? "incidents.max_count"
                                   : "incidents.max_gigabytes"));
    all.erase(oldest);
  }
}

}  // namespace deltamap::daemon
