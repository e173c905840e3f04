// SPDX-License-Identifier: Apache-2.0
#include "daemon/incidents/incident_keeper.hpp"

#include <algorithm>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "core/files/replace_file.hpp"
#include "daemon/incidents/ended_run.hpp"
#include "daemon/incidents/incident_picture.hpp"
#include "daemon/incidents/left_ring.hpp"
#include "daemon/incidents/recorded_scan.hpp"
#include "daemon/records/journal.hpp"
#include "daemon/settings/settings_documents.hpp"
#include "daemon/steps/run_begin.hpp"
#include "daemon/telemetry/version.hpp"

namespace deltamap::daemon {
namespace {

using drivers::port::ByteRecord;

constexpr double kLongestSegmentS = 15.0;  // where no checkpoint comes: no scan is localized
constexpr double kRingS = IncidentKeeper::kBeforeS + kCheckpointPeriodS;
constexpr double kFlushPeriodS = 1.0;
constexpr double kLeftPeriodS = 60.0;
constexpr double kRingFlushPeriodS = 0.1;  // what a killed daemon loses

ByteRecord note_at(Timestamp stamp, std::string_view note) {
  ByteRecord record;
  record.stamp = stamp;
  record.note = note;
  return record;
}

constexpr double kLeastOtherShare = 0.01;  // of the belief: with less another pose is not worth showing
constexpr double kScanBeforeS = 5.0;       // what is decoded at least: the laser may have been silent for a while

/// The newest row with its scan, on the newest map that is known here.
void draw(const std::filesystem::path& file, SegmentRing& ring, const Settings& settings, const LocalizationRow& row,
          const OccupancyGrid& map) {
  const SegmentRing::Segment& from = ring.segment_at(row.time - duration_from_seconds(kScanBeforeS));
  const auto records = [&](const TakeByteRecord& take) {
    for (const ByteRecord& said : from.so_far.beginning({}, from.began)) take(said);
    ring.read_from(from, take);
  };
  const bool has_other = row.belief.other_share >= kLeastOtherShare;
  replace_file(file,
               incident_picture({.map = map,
                                 .map_from_robot = row.map_from_robot,
                                 .covariance = row.covariance,
                                 .map_from_other = has_other ? std::optional{row.belief.map_from_other} : std::nullopt,
                                 .scan = recorded_scan(settings, row.time, records)}));
}

}  // namespace

IncidentKeeper::IncidentKeeper(Options options, Telemetry& telemetry, const LogTail& log, Hooks hooks)
    : options_{std::move(options)},
      telemetry_{telemetry},
      log_{log},
      hooks_{std::move(hooks)},
      output_{"incidents", options_.settings.incidents.folder, telemetry.outputs, hooks_.warn},
      so_far_{{options_.settings.robot.session.baud, options_.settings.laser.session.baud}},
      last_flush_{options_.began} {
  try {
    std::filesystem::create_directories(options_.settings.incidents.folder);
    lock_ = lock_of_folder(options_.settings.incidents.folder);
  } catch (const std::system_error&) {  // told by the first attempt
  }
  (void)output_.attempt(options_.began, [this] { begin_ring(options_.began); });
}

/// The run's first segment begins with its first notes: cut from there a recording repeats the run.
void IncidentKeeper::begin_ring(Timestamp now) {
  const std::filesystem::path folder = options_.settings.incidents.folder;
  std::filesystem::create_directories(folder);
  if (!lock_) lock_ = lock_of_folder(folder);
  if (!is_left_aside_) set_left_aside(folder);
  is_left_aside_ = true;
  remove_drafts(folder);
  const bool is_start = now == options_.began;
  ring_.emplace(folder / kRingFolder, kRingS);
  try {
    write_run_facts(ring_->folder(), options_.settings, *options_.map);
    begin_ring_segment(now, is_start ? nullptr : without_pose());
    if (is_start) {
      for (const std::string& note : options_.first_notes) ring_->write(note_at(now, note));
    }
  } catch (...) {  // a ring without a whole first segment holds nothing that replays: begun anew by the next record
    ring_.reset();
    throw;
  }
  options_.first_notes.clear();
}

void IncidentKeeper::write(const ByteRecord& record) {
  if (!ring_) begin_ring(record.stamp);
  if (std::exchange(has_gap_, false)) {
    ring_->write(note_at(record.stamp, kGapNote));
    if (open_) open_->write(note_at(record.stamp, kGapNote));
  }
  ring_->write(record);
  if (open_) open_->write(record);
}

void IncidentKeeper::hear(const ByteRecord& record, Timestamp now) {
  // A failed write leaves a gap: its bytes are gone.
  if (!output_.attempt(now, [&] { write(record); })) {
    has_gap_ = true;
    output_.count_lost();
  }
  so_far_.read(record);
}

void IncidentKeeper::hear(const LocalizationRow& row, Timestamp now) {
  newest_ = row;
  if (auto event = pose_watch_.observe(row)) raise(*std::move(event), now);
}

void IncidentKeeper::hear(std::shared_ptr<const Checkpoint> checkpoint, Timestamp now) {
  checkpoint_ = checkpoint;
  begin_segment(now, std::move(checkpoint));
}

void IncidentKeeper::begin_segment(Timestamp now, std::shared_ptr<const Checkpoint> checkpoint) {
  if (!ring_) return;
  (void)output_.attempt(now, [&] { begin_ring_segment(now, std::move(checkpoint)); });
}

void IncidentKeeper::begin_ring_segment(Timestamp now, std::shared_ptr<const Checkpoint> checkpoint) {
  const IncidentEvent none{IncidentKind::kDaemonEnded, now, ""};
  std::vector<ByteRecord> beginning{note_at(now, facts_note(begun_incident(none, now, checkpoint.get())))};
  if (checkpoint) {
    const auto notes = part_notes(options_.settings, *checkpoint);
    for (ByteRecord& record : so_far_.beginning(notes, now)) beginning.push_back(std::move(record));
  }
  ring_->begin_segment(now, so_far_, std::move(checkpoint), beginning);
}

/// What was known last of the map and of the wheels, and no pose.
std::shared_ptr<const Checkpoint> IncidentKeeper::without_pose() const {
  Checkpoint checkpoint;
  if (checkpoint_) {
    checkpoint = *checkpoint_;
  } else {
    checkpoint.map = options_.map;
    checkpoint.pose.first_map = options_.first_map;
    checkpoint.pose.revision = options_.revision;
  }
  checkpoint.pose.is_sure = false;
  return std::make_shared<const Checkpoint>(std::move(checkpoint));
}

control::CommandOutcome IncidentKeeper::hear(const MarkOrder& mark, Timestamp now) {
  const std::string words = mark.words.empty() ? "marked by an operator" : "marked by an operator: " + mark.words;
  raise({IncidentKind::kMark, now, words}, now);
  if (!open_) return {mark.ticket, false, "not kept: " + output_.why()};
  return {mark.ticket, true, "kept as " + open_->path().string() + "; half a minute more is added"};
}

void IncidentKeeper::raise(IncidentEvent event, Timestamp now) {
  const Timestamp wanted = now + duration_from_seconds(kAfterS);
  if (open_) {
    until_ = std::min(wanted, open_->incident().events.front().time + duration_from_seconds(kLongestAfterS));
    (void)output_.attempt(now, [&] { open_->add(event); });
    return;
  }
  const bool is_kept = output_.attempt(now, [&] {
    if (!ring_) begin_ring(now);
    open_incident(event);
  });
  if (!is_kept) return hooks_.warn("an incident is not kept (" + event.words + "): " + output_.why());
  until_ = wanted;
  hooks_.log("incident " + open_->incident().name + ": " + event.words);
  if (newest_) {
    const OccupancyGrid& map = checkpoint_ ? *checkpoint_->map : *options_.map;
    (void)output_.attempt(now, [&] {
      draw(open_->path() / kIncidentPicture, *ring_, options_.settings, *newest_, map);
      write_page(open_->path(), open_->incident());
    });
  }
  for (const std::string& line : within_limits(options_.settings.incidents, open_->incident().name)) hooks_.log(line);
}

Incident IncidentKeeper::begun_incident(const IncidentEvent& event, Timestamp from,
                                        const Checkpoint* checkpoint) const {
  Incident incident;
  incident.events = {event};
  incident.from = from;
  incident.begins_in_mid_run = checkpoint != nullptr;
  incident.first_revision = checkpoint ? checkpoint->pose.revision : options_.revision;
  incident.revision = newest_ ? newest_->revision : options_.revision;
  incident.first_map = options_.settings.map.file;
  incident.version = version_text();
  if (!newest_) return incident;
  incident.map_from_robot = newest_->map_from_robot;
  incident.is_sure = newest_->is_sure();
  incident.deviation_m = widest_deviation_m(newest_->covariance);
  return incident;
}

void IncidentKeeper::open_incident(const IncidentEvent& event) {
  const SegmentRing::Segment& from = ring_->segment_at(event.time - duration_from_seconds(kBeforeS));
  const bool is_part = from.checkpoint != nullptr;
  const auto records = [&](const IncidentFolder::TakeRecord& take) {
    if (is_part) {
      const auto notes = part_notes(options_.settings, *from.checkpoint);
      for (const ByteRecord& record : from.so_far.beginning(notes, from.began)) take(record);
    }
    ring_->read_from(from, take);
  };
  open_.emplace(options_.settings.incidents.folder,
                IncidentFolder::Content{
                    .incident = begun_incident(event, from.began, from.checkpoint.get()),
                    .settings = settings_as_yaml(is_part ? settings_of_a_part(options_.settings) : options_.settings),
                    .map = is_part ? from.checkpoint->map : options_.map,
                    .bauds = from.so_far.bauds(),
                    .log = log_.since(from.began),
                    .records = records});
}

void IncidentKeeper::look(Timestamp now) {
  if (is_left_aside_ && !is_left_kept_ && now >= left_due_) keep_left_run(now);
  for (IncidentEvent& event : run_watch_.observe(telemetry_, now)) raise(std::move(event), now);
  if (open_ && now >= until_) finish(now);
  if (ring_ && !ring_->is_empty() && seconds(now - ring_->newest().began) > kLongestSegmentS)
    begin_segment(now, without_pose());
  flush(now);
}

void IncidentKeeper::flush(Timestamp now) {
  if (seconds(now - last_ring_flush_) < kRingFlushPeriodS) return;
  last_ring_flush_ = now;
  if (ring_ && !output_.attempt(now, [this] { ring_->flush(); })) has_gap_ = true;
  if (seconds(now - last_flush_) < kFlushPeriodS) return;
  last_flush_ = now;
  if (open_) (void)output_.attempt(now, [this] { open_->flush(); });
  if (!ring_ || ring_->is_empty()) return;
  (void)output_.attempt(now, [&] {
    const IncidentEvent none{IncidentKind::kDaemonEnded, now, ""};
    const Timestamp measured = newest_ ? newest_->time : now;
    write_newest(ring_->folder(), begun_incident(none, measured, nullptr), log_.since(ring_->oldest().began));
  });
}

/// Where that fails this run's own ring goes on.
void IncidentKeeper::keep_left_run(Timestamp now) {
  const IncidentSettings& settings = options_.settings.incidents;
  std::string newest;
  try {
    keep_left(settings.folder, open_ ? open_->incident().name : "", [&](const KeptEnd& kept) {
      hooks_.warn(kept.line);
      newest = kept.name;
    });
    is_left_kept_ = true;
  } catch (const std::runtime_error& why) {
    if (left_due_ == Timestamp{})
      hooks_.warn(std::string("what the daemon before has left is not kept yet, and tried again each minute: ") +
                  why.what());
    left_due_ = now + duration_from_seconds(kLeftPeriodS);
  }
  if (newest.empty()) return;
  for (const std::string& line : within_limits(settings, newest)) hooks_.log(line);
}

void IncidentKeeper::finish(Timestamp now) {
  if (!output_.attempt(now, [&] { open_->finish(now, log_.since(open_->incident().from)); }))
    hooks_.warn("incident " + open_->incident().name + " lacks its end: " + output_.why());
  open_.reset();
}

void IncidentKeeper::close(Timestamp now) {
  output_.hurry();
  if (open_) finish(now);
  if (ring_) ring_->remove();
  ring_.reset();
}

std::unique_ptr<IncidentKeeper> begun_incident_keeper(IncidentKeeper::Options options, Telemetry& telemetry,
                                                      const LogTail& log, IncidentKeeper::Hooks hooks) {
  if (options.settings.incidents.folder.empty()) return nullptr;
  return std::make_unique<IncidentKeeper>(std::move(options), telemetry, log, std::move(hooks));
}

}  // namespace deltamap::daemon
