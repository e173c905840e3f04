// SPDX-License-Identifier: Apache-2.0
#include "daemon/records/live_recording.hpp"

#include <cerrno>
#include <cstdio>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "daemon/outputs/output_place.hpp"
#include "daemon/records/journal.hpp"
#include "daemon/settings/memory_places.hpp"
#include "daemon/settings/start_error.hpp"

namespace deltamap::daemon {
namespace {

using drivers::port::ByteRecord;
using drivers::port::PortId;

constexpr const char* kFull = "it has reached recording.max_gigabytes";

/// Renames the recording of the last run: after a crash the service starts again at once, and the recording of the
/// crash must survive. Returns an error where the disk is full or read-only; throws StartError for any other reason.
std::error_code keep_previous(const std::filesystem::path& recording, bool is_ring) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(recording, error)) return {};
  const std::filesystem::path previous = is_ring ? place_of_earlier(recording) : previous_recording(recording);
  std::filesystem::rename(recording, previous, error);
  const int reason = error.value();
  if (!error || reason == EROFS || reason == ENOSPC || reason == EDQUOT) return error;
  throw StartError(recording.string() + ": cannot be kept as " + previous.string() + ": " + error.message());
}

ByteRecord note_at(Timestamp stamp, std::string_view note, PortId port = PortId::kRobot) {
  ByteRecord record;
  record.port = port;
  record.stamp = stamp;
  record.note = note;
  return record;
}

}  // namespace

std::string judged_recording_place(const std::filesystem::path& file) {
  std::string why = judged_file_place(file);
  std::error_code error;
  const std::filesystem::path previous = previous_recording(file);
  if (!std::filesystem::is_directory(previous, error)) return why;
  throw StartError(file.string() + ": cannot be kept as " + previous.string() + ": is a directory");
}

LiveRecording::LiveRecording(Options options, Telemetry& telemetry, const RetryingOutput::Warn& warn)
    : options_{std::move(options)},
      telemetry_{telemetry},
      output_{"recording", options_.file, telemetry.outputs, warn},
      log_{warn},
      so_far_{options_.bauds},
      part_began_{options_.began},
      last_stamp_{options_.began} {
  options_.file = or_start_error([&] { return file_behind(options_.file); });
  (void)judged_recording_place(options_.file);
  lock_ = or_start_error([&] { return lock_of_file(options_.file); });
  for (const std::string& note : options_.first_notes) beginning_.push_back(note_at(last_stamp_, note));
  is_previous_kept_ = !keep_previous(options_.file, options_.ring.has_value());
  attempt(options_.began, [this] { go_on(); });
}

void LiveRecording::begin() {
  if (!lock_) lock_ = lock_of_file(options_.file);  // the folder may have been read-only at the start
  if (!is_previous_kept_) {
    if (const auto error = keep_previous(options_.file, options_.ring.has_value()))
      throw std::system_error(error, options_.file.string());
    is_previous_kept_ = true;
  }
  try {
    writer_.emplace(options_.file, so_far_.bauds());
    for (const ByteRecord& record : beginning_) writer_->write(record);
    writer_->flush();
  } catch (const std::exception&) {
    writer_.reset();  // the next attempt begins the file anew: without its first notes it says nothing of its run
    throw;
  }
  beginning_ = {};
}

/// The full part is closed, and kept as the recording of an earlier run is. Where the disk has no room for the next
/// one, that begins later.
void LiveRecording::begin_part(const Checkpoint& from, Timestamp now) {
  if (!options_.ring || ended_ || stopped_) return;
  if (part_began_ == options_.began && !beginning_.empty()) return;  // the run's first part is not on disk yet
  if (writer_ && !is_part_full(*options_.ring, writer_->size_bytes(), seconds(now - part_began_))) return;
  if (writer_) {
    attempt(now, [this] { writer_->close(); });
    writer_.reset();
    is_previous_kept_ = false;
  }
  part_began_ = now;
  beginning_ = so_far_.beginning(options_.part_notes(from), last_stamp_);
  attempt(now, [this] { begin(); });
  drop_oldest_parts(options_.file, *options_.ring);
}

void LiveRecording::go_on() {
  if (!writer_) begin();
  if (!has_gap_) return;
  writer_->write(note_at(last_stamp_, kGapNote));
  const drivers::port::FirstBauds bauds = so_far_.bauds();
  writer_->write(note_at(last_stamp_, drivers::port::baud_note(bauds.robot), PortId::kRobot));
  writer_->write(note_at(last_stamp_, drivers::port::baud_note(bauds.laser), PortId::kLaser));
  for (const std::string& note : so_far_.site_notes()) writer_->write(note_at(last_stamp_, note));
  if (!so_far_.pause_note().empty()) writer_->write(note_at(last_stamp_, so_far_.pause_note()));
  writer_->flush();
  has_gap_ = false;
}

void LiveRecording::attempt(Timestamp now, const std::function<void()>& write) {
  // A failed write leaves a gap: its bytes are gone, and so may be bytes that the writer still held.
  if (!output_.attempt(now, write)) has_gap_ = true;
  telemetry_.records.set(output_.works());
  if (writer_) telemetry_.recorded_bytes.set(writer_->size_bytes());
}

void LiveRecording::write(const ByteRecord& record, Timestamp now) {
  if (ended_) return;
  last_stamp_ = record.stamp;
  if (stopped_) return so_far_.read(record);
  attempt(now, [&] {
    go_on();
    writer_->write(record);
  });
  so_far_.read(record);
  if (!output_.works()) return output_.count_lost();
  if (options_.ring || static_cast<double>(writer_->size_bytes()) <= options_.max_gigabytes * 1e9) return;
  log_(std::string("the recording ends: ").append(kFull));
  ended_ = true;
  output_.end(now, kFull);
  writer_.reset();
  telemetry_.records.set(false);
}

std::string LiveRecording::stop(Timestamp now) {
  if (ended_) throw std::runtime_error(std::string("the recording has ended: ") + kFull);
  if (stopped_) throw std::runtime_error("the recording is stopped already");
  flush(now);
  const std::string behind = output_.works() ? "" : "; its end is missing: " + output_.why();
  stopped_ = true;
  output_.end(now, "stopped by an operator");
  telemetry_.records.set(false);
  const double megabytes = writer_ ? 1e-6 * static_cast<double>(writer_->size_bytes()) : 0.0;
  char text[32];
  (void)std::snprintf(text, sizeof text, "%.1f MB", megabytes);
  return "the recording stops: " + options_.file.string() + ", " + text + behind;
}

std::string LiveRecording::start(Timestamp now) {
  if (ended_) throw std::runtime_error(std::string("the recording has ended: ") + kFull);
  if (!stopped_) throw std::runtime_error("it records already: " + options_.file.string());
  stopped_ = false;
  has_gap_ = true;
  output_.begin_again();
  flush(now);
  const std::string where =
      options_.file.string() +
      ", behind a gap: a replay begins at the start of the run and does not repeat it bit for bit";
  return output_.works() ? "the recording goes on in " + where
                         : "the recording goes on as soon as it can (" + output_.why() + ") in " + where;
}

void LiveRecording::flush(Timestamp now) {
  if (ended_ || stopped_) return;
  attempt(now, [this] {
    go_on();
    writer_->flush();
  });
}

void LiveRecording::close(Timestamp now) {
  if (ended_) return;
  if (stopped_) {
    stopped_ = false;
    has_gap_ = false;
    output_.begin_again();
  }
  output_.hurry();
  attempt(now, [this] {
    go_on();
    writer_->close();
  });
}

}  // namespace deltamap::daemon
