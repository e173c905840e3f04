// SPDX-License-Identifier: Apache-2.0
#include "daemon/incidents/left_ring.hpp"

#include <algorithm>
#include <fstream>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "core/counted.hpp"
#include "core/files/grid_file.hpp"
#include "core/files/replace_file.hpp"
#include "core/files/text_of_file.hpp"
#include "daemon/incidents/segment_ring.hpp"
#include "daemon/records/journal.hpp"
#include "daemon/settings/settings_documents.hpp"
#include "daemon/steps/run_begin.hpp"

namespace deltamap::daemon {
namespace {

namespace fs = std::filesystem;
using drivers::port::ByteLogReader;
using drivers::port::ByteRecord;

constexpr std::string_view kFactsHead = "incident begins ";
constexpr const char* kPartSettings = "part_settings.yaml";
constexpr const char* kNewestFacts = "newest.json";

/// As replace_file(), without waiting for the disk: it is written each second.
void replace_without_syncing(const fs::path& file, const std::string& content) {
  const fs::path draft = file.string() + ".part";
  std::ofstream out(draft, std::ios::binary | std::ios::trunc);
  out << content;
  out.close();
  std::error_code error;
  if (out) fs::rename(draft, file, error);
  if (!out || error) throw std::runtime_error(file.string() + ": cannot be written");
}

}  // namespace

void write_run_facts(const fs::path& ring, const Settings& settings, const OccupancyGrid& map) {
  replace_file(ring / kIncidentSettings, settings_as_yaml(settings));
  replace_file(ring / kPartSettings, settings_as_yaml(settings_of_a_part(settings)));
  write_grid(map, ring / kIncidentMap);
}

void write_newest(const fs::path& ring, const Incident& newest, const std::string& log) {
  replace_without_syncing(ring / kNewestFacts, json_text(newest));
  replace_without_syncing(ring / kIncidentLog, log);
}

std::string facts_note(const Incident& incident) {
  std::string note = json_text(incident);
  note.pop_back();                                    // its line end: a reader takes what ends a note for no part of it
  std::replace(note.begin(), note.end(), '\n', ' ');  // between its words; within them they are escaped
  return std::string(kFactsHead) + note;
}

LeftRing::LeftRing(fs::path folder) : folder_{std::move(folder)} {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder_, error)) {
    if (const auto number = SegmentRing::number_of(entry.path().filename().string())) numbers_.push_back(*number);
  }
  std::sort(numbers_.begin(), numbers_.end());
  for (const std::uint64_t number : numbers_) look_at(number, number == numbers_.back());
}

void LeftRing::look_at(std::uint64_t number, bool is_last) {
  std::string why;
  try {
    ByteLogReader reader{folder_ / SegmentRing::name_of(number)};
    while (const auto record = reader.next()) last_ = record->stamp;
    const drivers::port::LogFaults faults = reader.faults();
    if (faults.cut) {
      why = "its last block was torn, and " + counted(faults.cut->unread_bytes, "byte") + " of it are left out";
    } else if (faults.lacks_records || (faults.lacks_end && !is_last)) {
      why = "records are missing in its midst";
    }
  } catch (const std::runtime_error&) {
    // Nothing had reached it, or the power went before anything reached the disk.
    why = "its last seconds never reached the disk";
  }
  if (why.empty()) return;
  if (!is_last) why = "some seconds before its end could not be read whole";
  lacks_ = std::move(why);
}

void LeftRing::read_from(std::uint64_t segment, const TakeRecord& take) const {
  bool has_gap = false;
  for (const std::uint64_t number : numbers_) {
    if (number < segment) continue;
    try {
      ByteLogReader reader{folder_ / SegmentRing::name_of(number)};
      while (const auto record = reader.next()) {
        if (std::exchange(has_gap, false)) {
          ByteRecord gap;
          gap.stamp = record->stamp;
          gap.note = kGapNote;
          take(gap);
        }
        take(*record);
      }
      has_gap = reader.faults().cut.has_value();
    } catch (const std::runtime_error&) {  // of the reader alone: told by lacks()
      has_gap = true;
    }
  }
}

std::optional<LeftRing::Start> LeftRing::oldest_start() const {
  for (const std::uint64_t number : numbers_) {
    if (auto start = start_at(number)) return start;
  }
  return std::nullopt;
}

std::optional<LeftRing::Start> LeftRing::start_at(std::uint64_t number) const {
  try {
    Start start{number, {}, {}, nullptr, {}};
    ByteLogReader reader{folder_ / SegmentRing::name_of_beginning(number)};
    const auto first = reader.next();
    if (!first || !first->note.starts_with(kFactsHead)) return std::nullopt;
    start.facts = incident_of(first->note.substr(kFactsHead.size()));
    start.facts.events.clear();
    start.settings = text_of_file(folder_ / (start.facts.begins_in_mid_run ? kPartSettings : kIncidentSettings));
    BeginReader begin;
    while (auto record = reader.next()) {
      begin.read(record->note);
      start.beginning.push_back(*std::move(record));
    }
    if (!reader.faults().lines().empty() || begin.is_incomplete()) return std::nullopt;
    if (begin.begin()) start.map = begin.begin()->start.map;
    if (!start.map) start.map = std::make_shared<const OccupancyGrid>(read_grid(folder_ / kIncidentMap));
    return start;
  } catch (const std::runtime_error&) {  // damaged, or never on disk
    return std::nullopt;
  }
}

/// Nothing: the power went before it reached the disk.
std::optional<Incident> LeftRing::newest_facts() const {
  try {
    return incident_of(text_of_file(folder_ / kNewestFacts));
  } catch (const std::runtime_error&) {
    return std::nullopt;
  }
}

Incident LeftRing::newest(const Start& start) const {
  Incident facts = start.facts;
  if (const auto newest = newest_facts()) {
    facts.map_from_robot = newest->map_from_robot;
    facts.is_sure = newest->is_sure;
    facts.deviation_m = newest->deviation_m;
    facts.revision = newest->revision;
  }
  return facts;
}

std::optional<Timestamp> LeftRing::pose_time() const {
  const auto newest = newest_facts();
  return newest && newest->map_from_robot ? std::optional{newest->from} : std::nullopt;
}

std::shared_ptr<const OccupancyGrid> LeftRing::newest_map() const {
  for (std::size_t left = numbers_.size(); left > 0; --left) {
    if (const auto start = start_at(numbers_[left - 1])) return start->map;
  }
  return nullptr;
}

std::string LeftRing::log() const {
  try {
    return text_of_file(folder_ / kIncidentLog);
  } catch (const std::runtime_error&) {
    return {};
  }
}

}  // namespace deltamap::daemon
