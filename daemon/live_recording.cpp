// SPDX-License-Identifier: Apache-2.0
#include "daemon/live_recording.hpp"

#include <cerrno>
#include <system_error>
#include <utility>

#include "daemon/journal.hpp"
#include "daemon/output_place.hpp"
#include "daemon/start_error.hpp"

namespace deltamap::daemon {
namespace {

using drivers::port::ByteRecord;
using drivers::port::PortId;

/// A service that has crashed is started again at once: the recording of the crash must outlive that. Answers why it
/// cannot be kept now.
std::error_code keep_previous(const std::filesystem::path& recording) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(recording, error)) return {};
  std::filesystem::path previous = recording;
  previous.replace_extension(".previous" + recording.extension().string());
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

LiveRecording::LiveRecording(Options options, Telemetry& telemetry, const RetryingOutput::Warn& warn)
    : options_{std::move(options)},
      telemetry_{telemetry},
      output_{"recording", options_.file, telemetry.outputs, warn},
      log_{warn},
      bauds_{options_.bauds.robot, options_.bauds.laser},
      last_stamp_{options_.began} {
  options_.file = or_start_error([&] { return file_behind(options_.file); });
  (void)judged_recording_place(options_.file);
  lock_ = or_start_error([&] { return lock_of_file(options_.file); });
  is_previous_kept_ = !keep_previous(options_.file);
  attempt(options_.began, [this] { go_on(); });
}

void LiveRecording::begin() {
  if (!lock_) lock_ = lock_of_file(options_.file);  // there could be none before
  if (!is_previous_kept_) {
    if (const auto error = keep_previous(options_.file)) throw std::system_error(error, options_.file.string());
    is_previous_kept_ = true;
  }
  try {
    writer_.emplace(options_.file, drivers::port::FirstBauds{bauds_[0], bauds_[1]});
    for (const std::string& note : options_.first_notes) writer_->write(note_at(last_stamp_, note));
    writer_->flush();
  } catch (const std::exception&) {
    writer_.reset();  // the next attempt begins the file anew: without its first notes it says nothing of its run
    throw;
  }
  options_.first_notes.clear();
}

void LiveRecording::go_on() {
  if (!writer_) begin();
  if (!has_gap_) return;
  writer_->write(note_at(last_stamp_, kGapNote));
  for (const PortId port : {PortId::kRobot, PortId::kLaser}) {
    writer_->write(note_at(last_stamp_, drivers::port::baud_note(bauds_[static_cast<std::size_t>(port)]), port));
  }
  if (!pause_note_.empty()) writer_->write(note_at(last_stamp_, pause_note_));
  writer_->flush();
  has_gap_ = false;
}

void LiveRecording::attempt(Timestamp now, const std::function<void()>& write) {
  // What was to be written is gone where it failed, and so may be what waited for the disk.
  if (!output_.attempt(now, write)) has_gap_ = true;
  telemetry_.records.set(output_.works());
  if (writer_) telemetry_.recorded_bytes.set(writer_->size_bytes());
}

void LiveRecording::remember(const ByteRecord& record) {
  if (record.note.empty()) return;
  const auto baud = drivers::port::baud_of_note(record.note);
  if (baud) bauds_[static_cast<std::size_t>(record.port)] = *baud;
  const auto decision = decision_of_note(record.note);
  const bool is_pause =
      decision && (decision->kind == Decision::Kind::kPaused || decision->kind == Decision::Kind::kResumed);
  if (is_pause) pause_note_ = record.note;
}

void LiveRecording::write(const ByteRecord& record, Timestamp now) {
  if (ended_) return;
  last_stamp_ = record.stamp;
  attempt(now, [&] {
    go_on();
    writer_->write(record);
  });
  remember(record);
  if (!output_.works()) return output_.count_lost();
  if (static_cast<double>(writer_->size_bytes()) <= options_.max_gigabytes * 1e9) return;
  const std::string why = "it has reached recording.max_gigabytes";
  log_("the recording ends: " + why);
  ended_ = true;
  output_.end(now, why);
  writer_.reset();
  telemetry_.records.set(false);
}

void LiveRecording::flush(Timestamp now) {
  if (ended_) return;
  attempt(now, [this] {
    go_on();
    writer_->flush();
  });
}

void LiveRecording::close(Timestamp now) {
  if (ended_) return;
  output_.hurry();
  attempt(now, [this] {
    go_on();
    writer_->close();
  });
}

}  // namespace deltamap::daemon
