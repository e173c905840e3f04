// SPDX-License-Identifier: Apache-2.0
#include "daemon/recorder.hpp"

#include <chrono>
#include <stdexcept>
#include <system_error>

namespace deltamap::daemon {
namespace {

constexpr std::chrono::seconds kFlushPeriod{1};

/// A service that has crashed is started again at once: the recording of the crash must outlive that.
void keep_previous(const std::filesystem::path& recording) {
  if (!std::filesystem::is_regular_file(recording)) return;
  std::filesystem::path previous = recording;
  previous.replace_extension(".previous" + recording.extension().string());
  std::error_code error;
  std::filesystem::rename(recording, previous, error);
  if (error)
    throw std::runtime_error(recording.string() + ": cannot be kept as " + previous.string() + ": " + error.message());
}

}  // namespace

using drivers::port::ByteRecord;

Recorder::Recorder(const Options& options, Telemetry& telemetry, Hooks hooks)
    : telemetry_{telemetry},
      hooks_{std::move(hooks)},
      max_bytes_{options.max_gigabytes * 1e9},
      memory_{options.memory, hooks_.log},
      last_stamp_{options.began} {
  if (!options.recording.empty()) {
    keep_previous(options.recording);
    recording_.emplace(options.recording, options.bauds);
    telemetry_.records.set(true);
  }
  for (const std::string& note : options.first_notes) write(note);
  if (!options.trajectory.empty()) trajectory_.emplace(options.trajectory);
  if (options.localization.empty()) return;
  localization_.emplace(options.localization);
  localization_->write(csv_header());
}

void Recorder::run() {
  auto last_flush = std::chrono::steady_clock::now();
  for (;;) {
    const bool closed = closed_.load(std::memory_order_acquire);
    bool found = drain(from_io_);
    found = drain(from_localization_) || found;
    found = drain(from_awareness_) || found;
    if (closed && !found) break;
    if (const auto now = std::chrono::steady_clock::now(); now - last_flush >= kFlushPeriod) {
      flush();
      last_flush = now;
    }
    if (!found) (void)bell_.try_acquire_for(kFlushPeriod);
  }
  flush();
  if (recording_) recording_->close();
}

void Recorder::close() {
  closed_.store(true, std::memory_order_release);
  bell_.release();
}

bool Recorder::drain(RecorderInput& input) {
  bool found = false;
  while (auto item = input.take()) {
    write(std::move(*item));
    (void)bell_.try_acquire();
    found = true;
  }
  return found;
}

void Recorder::write(RecorderItem&& item) {
  if (auto* bytes = std::get_if<ByteRecord>(&item)) {
    last_stamp_ = bytes->stamp;
    record(*bytes);
  } else if (auto* note = std::get_if<JournalNote>(&item)) {
    // Where a note stands among the bytes means nothing: it names its scan.
    ByteRecord noted;
    noted.stamp = last_stamp_;
    noted.note = std::move(*note);
    record(noted);
  } else if (const auto* point = std::get_if<TrajectoryPoint>(&item)) {
    if (trajectory_) trajectory_->write(tum_line(*point));
  } else if (const auto* row = std::get_if<std::unique_ptr<const LocalizationRow>>(&item)) {
    if (localization_) localization_->write(csv_line(**row));
  } else if (const auto* pose = std::get_if<std::unique_ptr<const KeptPose>>(&item)) {
    memory_.keep(**pose);
  } else if (const auto* stability = std::get_if<std::unique_ptr<const KeptStability>>(&item)) {
    memory_.keep(**stability);
  } else if (const auto* order = std::get_if<std::unique_ptr<const SaveOrder>>(&item)) {
    save(**order);
  } else {
    hooks_.log(std::get<LogLine>(item).text);
  }
}

void Recorder::save(const SaveOrder& order) {
  const CommandOutcome outcome = memory_.save(order);
  if (hooks_.saved) hooks_.saved(outcome);
}

void Recorder::record(const ByteRecord& record) {
  if (!recording_) return;
  try {
    recording_->write(record);
  } catch (const std::exception& error) {
    return end_recording(error.what());
  }
  telemetry_.recorded_bytes.set(recording_->size_bytes());
  if (static_cast<double>(recording_->size_bytes()) > max_bytes_)
    end_recording("it has reached recording.max_gigabytes");
}

void Recorder::end_recording(const std::string& why) {
  hooks_.log("the recording ends: " + why);
  telemetry_.records.set(false);
  recording_.reset();
}

void Recorder::flush() {
  if (trajectory_) trajectory_->flush();
  if (localization_) localization_->flush();
  if (!recording_) return;
  try {
    recording_->flush();
  } catch (const std::exception& error) {
    end_recording(error.what());
  }
}

}  // namespace deltamap::daemon
