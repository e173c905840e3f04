// SPDX-License-Identifier: Apache-2.0
#include "tool/view/run_events.hpp"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <utility>

#include "tool/info/info_text.hpp"

namespace deltamap::tool {

void RunEvents::add(Event event) {
  const std::scoped_lock lock{mutex_};
  if (events_.size() < kMostEvents) events_.push_back(std::move(event));
}

void RunEvents::observe(const daemon::LocalizationRow& row) {
  const auto before = std::exchange(newest_, row.time);
  if (const double pause_s = before ? seconds(row.time - *before) : 0.0; pause_s > kGapS) {
    char words[64];
    (void)std::snprintf(words, sizeof words, "no scan for %.1f s", pause_s);
    add({*before, "gap", words});
  }
  if (const auto event = pose_watch_.observe(row)) add({event->time, "loss", event->words});
}

void RunEvents::observe(const daemon::ChangeNote& note) {
  if (note.revision)
    add({note.time, "change", "revision " + std::to_string(*note.revision)});
  else
    add({note.time, "refusal", note.reason});
}

void RunEvents::add_orders(const std::vector<daemon::Decision>& commands) {
  for (const daemon::Decision& command : commands) {
    if (command.scan_time && !is_of_begin(command)) add({*command.scan_time, "order", words_of_command(command)});
  }
}

void RunEvents::add(const daemon::Incident& incident) {
  for (const daemon::IncidentEvent& event : incident.events)
    add({event.time, "incident", std::string(name_of(event.kind)) + ": " + event.words});
}

std::string RunEvents::json() const {
  std::vector<Event> events;
  {
    const std::scoped_lock lock{mutex_};
    events = events_;
  }
  std::stable_sort(events.begin(), events.end(),
                   [](const Event& one, const Event& other) { return one.time < other.time; });
  auto json = nlohmann::ordered_json::array();
  for (const Event& event : events)
    json.push_back({{"time", unix_seconds(event.time)}, {"kind", event.kind}, {"words", event.words}});
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace deltamap::tool
