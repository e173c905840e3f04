// SPDX-License-Identifier: Apache-2.0
#include "daemon/incidents/ended_run.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <system_error>
#include <utility>
#include <vector>

#include "core/files/replace_file.hpp"
#include "core/utc_text.hpp"
#include "daemon/incidents/incident_folder.hpp"
#include "daemon/incidents/incident_list.hpp"
#include "daemon/incidents/incident_picture.hpp"
#include "daemon/incidents/left_ring.hpp"
#include "daemon/incidents/recorded_scan.hpp"
#include "daemon/incidents/segment_ring.hpp"
#include "daemon/settings/settings.hpp"

namespace deltamap::daemon {
namespace {

namespace fs = std::filesystem;
using drivers::port::ByteLogReader;
using drivers::port::ByteLogWriter;
using drivers::port::ByteRecord;
using drivers::port::FirstBauds;

constexpr std::string_view kLeftHead = ".left-";
constexpr const char* kLeftDraft = "draft";
constexpr std::size_t kMostLeft = 3;

/// By number, oldest first.
std::vector<std::pair<unsigned, fs::path>> left_in(const fs::path& parent) {
  std::vector<std::pair<unsigned, fs::path>> left;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(parent, error)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(kLeftHead)) continue;
    unsigned number = 0;
    (void)std::from_chars(name.data() + kLeftHead.size(), name.data() + name.size(), number);
    left.emplace_back(number, entry.path());
  }
  std::sort(left.begin(), left.end());
  return left;
}

std::string ended_at(Timestamp time) { return "the daemon before ended without a word at " + utc_text(time); }

std::string rounded_s(Timestamp from, Timestamp to) { return std::to_string(std::lround(seconds(to - from))) + " s"; }

/// The line speeds that a recording of these records begins with.
class BaudsOf {
 public:
  void read(const ByteRecord& record) {
    unsigned& baud = record.port == drivers::port::PortId::kRobot ? bauds_.robot : bauds_.laser;
    if (baud == 0) baud = record.baud;
  }
  [[nodiscard]] const FirstBauds& bauds() const { return bauds_; }

 private:
  FirstBauds bauds_;
};

/// What an incident's recording holds that is whole, and where the ring goes on behind it.
struct Kept {
  FirstBauds bauds;
  std::optional<ByteRecord> last;  // that has bytes
  std::size_t notes_behind = 0;
  Timestamp end;  // of its newest record
};

Kept kept_in(const fs::path& recording) {
  Kept kept;
  BaudsOf bauds;
  ByteLogReader reader{recording};
  while (const auto record = reader.next()) {
    bauds.read(*record);
    kept.end = record->stamp;
    ++kept.notes_behind;
    if (record->bytes.empty()) continue;
    kept.last = *record;
    kept.notes_behind = 0;
  }
  kept.bauds = bauds.bauds();
  return kept;
}

bool holds(const fs::path& recording, const ByteRecord& wanted) {
  ByteLogReader reader{recording};
  while (const auto record = reader.next()) {
    if (*record == wanted) return true;
  }
  return false;
}

/// How many records of the ring are in the incident already; nothing: the ring is of another time. Either of them may
/// have been handed to the kernel a little further than the other.
std::optional<std::size_t> records_before(const LeftRing& ring, const Kept& kept, const fs::path& recording) {
  std::optional<std::size_t> found;
  std::optional<ByteRecord> newest;
  std::size_t read = 0;
  ring.read_all([&](const ByteRecord& record) {
    ++read;
    if (kept.last && record == *kept.last) found = read + kept.notes_behind;
    if (!record.bytes.empty()) newest = record;
  });
  if (!found && newest && holds(recording, *newest)) return read;
  return found;
}

/// Rewrites the incident's recording with what the ring holds behind it, and says when that ends: where the ring is
/// damaged, the incident's own records may be newer. Nothing where it does not go on there.
std::optional<Timestamp> completed(const StoredIncident& stored, const LeftRing& ring, IncidentEvent end) {
  const fs::path recording = stored.folder / kIncidentRecording;
  const Kept kept = kept_in(recording);
  const auto before = records_before(ring, kept, recording);
  if (!before) return std::nullopt;
  const fs::path draft = recording.string() + ".part";
  {
    ByteLogWriter writer{draft, kept.bauds};
    ByteLogReader reader{recording};
    while (const auto record = reader.next()) writer.write(*record);
    std::size_t read = 0;
    ring.read_all([&](const ByteRecord& record) {
      if (++read > *before) writer.write(record);
    });
    writer.close();
  }
  move_into_place(draft, recording);
  if (const std::string log = ring.log(); !log.empty()) replace_file(stored.folder / kIncidentLog, log);
  Incident incident = stored.incident;
  end.time = std::max(end.time, kept.end);
  incident.events.push_back(end);
  incident.to = end.time;
  incident.lacks = ring.lacks();
  write_page(stored.folder, incident);
  return end.time;
}

/// What the daemon was about to keep of its own run. What it had begun to make of an earlier one's is made anew.
std::vector<IncidentEvent> events_of_draft(const fs::path& left) {
  try {
    std::vector<IncidentEvent> events = read_incident(left / kLeftDraft).events;
    if (events.back().kind == IncidentKind::kDaemonEnded) events.clear();
    return events;
  } catch (const std::runtime_error&) {  // there was none, or nothing of it had come to disk
    return {};
  }
}

/// The newest pose that is known with its scan, on the newest map. Why there is no picture; empty: there is one, or no
/// pose was known.
std::string drawn(const IncidentFolder& folder, const LeftRing& ring, const std::string& settings,
                  const std::function<void(const TakeByteRecord&)>& records) {
  const Incident& incident = folder.incident();
  const auto time = ring.pose_time();
  if (!time) return "";
  try {
    const auto map = ring.newest_map();
    const PoseCovariance widest = PoseCovariance::Identity() * incident.deviation_m * incident.deviation_m;
    replace_file(
        folder.path() / kIncidentPicture,
        incident_picture({.map = *map,
                          .map_from_robot = *incident.map_from_robot,
                          .covariance = widest,
                          .scan = recorded_scan(parse_settings(settings, kIncidentSettings), *time, records)}));
    write_page(folder.path(), incident);
    return "";
  } catch (const std::runtime_error& why) {
    return std::string("without a picture: ") + why.what();
  }
}

KeptEnd kept_as_new(const fs::path& parent, const fs::path& left, const LeftRing& ring, const IncidentEvent& end) {
  const auto start = ring.oldest_start();
  if (!start) return {ended_at(end.time) + "; what its ring holds does not replay: no beginning is whole", ""};
  Incident incident = ring.newest(*start);
  incident.events = events_of_draft(left);
  incident.events.push_back(end);
  incident.to = end.time;
  incident.lacks = ring.lacks();
  BaudsOf bauds;
  for (const ByteRecord& record : start->beginning) bauds.read(record);
  ring.read_from(start->segment, [&](const ByteRecord& record) { bauds.read(record); });
  const auto records = [&](const IncidentFolder::TakeRecord& take) {
    for (const ByteRecord& record : start->beginning) take(record);
    ring.read_from(start->segment, take);
  };
  const IncidentFolder folder{parent, IncidentFolder::Content{.incident = incident,
                                                              .settings = start->settings,
                                                              .map = start->map,
                                                              .bauds = bauds.bauds(),
                                                              .log = ring.log(),
                                                              .records = records}};
  std::string lacks = incident.lacks.empty() ? "" : "; " + incident.lacks;
  if (const std::string why = drawn(folder, ring, start->settings, records); !why.empty()) lacks += "; " + why;
  return {ended_at(end.time) + ": its last " + rounded_s(incident.from, end.time) + " are kept as incident " +
              folder.incident().name + lacks,
          folder.incident().name};
}

/// Whether the ring is worked into the incident already, whose own records may reach beyond it.
bool has_end_of(const StoredIncident& stored, const LeftRing& ring) {
  const Incident& incident = stored.incident;
  const auto is_end = [](const IncidentEvent& event) { return event.kind == IncidentKind::kDaemonEnded; };
  const auto end = std::find_if(incident.events.begin(), incident.events.end(), is_end);
  if (end == incident.events.end() || end->time < *ring.last() || incident.from > *ring.last()) return false;
  if (end->time == *ring.last()) return true;
  try {
    const fs::path recording = stored.folder / kIncidentRecording;
    return records_before(ring, kept_in(recording), recording).has_value();
  } catch (const std::runtime_error&) {  // it is unreadable by now: what the ring holds is kept
    return false;
  }
}

/// Incidents that some daemon was keeping, and this one is not.
std::vector<StoredIncident> unfinished_in(const fs::path& parent, const std::string& own) {
  std::vector<StoredIncident> all = incidents_in(parent);
  std::erase_if(all, [&](const StoredIncident& one) {
    return one.incident.to || !one.incident.lacks.empty() || one.incident.name == own;
  });
  return all;
}

KeptEnd kept_end(const fs::path& parent, const fs::path& left, const std::string& own) {
  const LeftRing ring{left};
  if (!ring.last()) return {"the daemon before ended without a word, before anything of it was on disk", ""};
  const IncidentEvent end{IncidentKind::kDaemonEnded, *ring.last(), "the daemon ended without a word"};
  for (const StoredIncident& stored : incidents_in(parent)) {
    if (has_end_of(stored, ring)) return {};  // this process, too, was killed behind that
  }
  for (const StoredIncident& stored : unfinished_in(parent, own)) {
    std::optional<Timestamp> ended;
    try {
      ended = completed(stored, ring, end);
    } catch (const std::runtime_error&) {
      if (fs::is_regular_file(stored.folder / kIncidentRecording)) throw;  // the disk is full
    }
    if (!ended) continue;
    const std::string lacks = ring.lacks().empty() ? "" : "; " + ring.lacks();
    return {
        ended_at(*ended) + ": incident " + stored.incident.name + ", which it was keeping, has been completed" + lacks,
        stored.incident.name};
  }
  return kept_as_new(parent, left, ring, end);
}

/// Nothing that was left goes on where this one ends.
KeptEnd marked_incomplete(const StoredIncident& stored) {
  Incident incident = stored.incident;
  incident.lacks = "its end was never written, for the daemon ended without a word or the disk was full";
  try {
    incident.to = kept_in(stored.folder / kIncidentRecording).end;
  } catch (const std::runtime_error& why) {
    incident.lacks += ", and its recording cannot be read";
  }
  write_page(stored.folder, incident);
  return {"incident " + incident.name + " is not complete: " + incident.lacks, incident.name};
}

}  // namespace

void set_left_aside(const fs::path& parent) {
  const fs::path ring = parent / kRingFolder;
  std::error_code error;
  if (fs::is_directory(ring, error)) {
    if (const auto draft = draft_in(parent)) fs::rename(*draft, ring / kLeftDraft, error);
    auto left = left_in(parent);
    const unsigned number = left.empty() ? 1 : left.back().first + 1;
    fs::rename(ring, parent / (std::string(kLeftHead) + std::to_string(number)), error);
    if (error) throw std::runtime_error(ring.string() + ": cannot be moved: " + error.message());
    for (std::size_t i = 0; i + kMostLeft <= left.size(); ++i) remove_at_once(left[i].second);
  }
}

void keep_left(const fs::path& parent, const std::string& own, const std::function<void(const KeptEnd&)>& tell) {
  for (const auto& [number, folder] : left_in(parent)) {
    if (const KeptEnd kept = kept_end(parent, folder, own); !kept.line.empty()) tell(kept);
    remove_at_once(folder);
  }
  for (const StoredIncident& stored : unfinished_in(parent, own)) tell(marked_incomplete(stored));
}

}  // namespace deltamap::daemon
