// SPDX-License-Identifier: Apache-2.0
#include "daemon/records/recorder.hpp"

#include <chrono>
#include <stdexcept>
#include <thread>
#include <utility>

#include "drivers/port/port_clock.hpp"

namespace deltamap::daemon {
namespace {

constexpr std::chrono::seconds kFlushPeriod{1};
// A robot's bytes come in hundreds of pieces a second: each look takes all that have come.
constexpr std::chrono::milliseconds kLookPeriod{50};
constexpr const char* kOnlyFromTheStart =
    "a recording begins with the run, for a replay needs what the devices said and the map was then; set it and "
    "restart";

Recorder::Hooks with_warnings(Recorder::Hooks hooks) {
  if (!hooks.warn) hooks.warn = hooks.log;
  return hooks;
}

}  // namespace

using drivers::port::ByteRecord;

Recorder::Recorder(const Options& options, Telemetry& telemetry, Hooks hooks)
    : hooks_{with_warnings(std::move(hooks))},
      listener_{options.listener},
      memory_{options.memory, telemetry.outputs, hooks_.warn},
      now_{options.began},
      last_stamp_{options.began} {
  if (!options.recording.empty()) {
    recording_.emplace(LiveRecording::Options{.file = options.recording,
                                              .bauds = options.bauds,
                                              .first_notes = options.first_notes,
                                              .began = options.began,
                                              .max_gigabytes = options.max_gigabytes,
                                              .ring = options.ring,
                                              .part_notes = options.part_notes},
                       telemetry, hooks_.warn);
  }
  const auto begin = [&](std::optional<LiveLines>& lines, const char* name, const std::filesystem::path& file) {
    if (file.empty()) return;
    lines.emplace(file, RetryingOutput{name, file, telemetry.outputs, hooks_.warn});
    lines->flush(now_);
  };
  begin(trajectory_, "trajectory", options.trajectory);
  begin(localization_, "localization", options.localization);
  if (localization_) localization_->write(csv_header(), now_);
}

void Recorder::run() {
  auto last_flush = std::chrono::steady_clock::now();
  for (;;) {
    pulse_.beat();
    const bool closed = closed_.load(std::memory_order_acquire);
    bool found = drain(from_io_);
    found = drain(from_localization_) || found;
    found = drain(from_awareness_) || found;
    found = drain(from_map_) || found;
    found = drain(from_control_) || found;
    if (listener_) listener_->look(drivers::port::port_clock_now());
    if (closed && !found) break;
    if (const auto now = std::chrono::steady_clock::now(); now - last_flush >= kFlushPeriod) {
      flush();
      last_flush = now;
    }
    if (!closed) std::this_thread::sleep_for(kLookPeriod);
  }
  flush();
  if (trajectory_) trajectory_->close(now_);
  if (localization_) localization_->close(now_);
  memory_.close(now_);
  if (recording_) recording_->close(now_);
  if (listener_) listener_->close(now_);
}

void Recorder::close() { closed_.store(true, std::memory_order_release); }

bool Recorder::drain(RecorderInput& input) {
  bool found = false;
  while (auto item = input.try_receive()) {
    write(std::move(*item));
    found = true;
  }
  return found;
}

void Recorder::write(RecorderItem&& item) {
  if (auto* bytes = std::get_if<ByteRecord>(&item)) {
    last_stamp_ = bytes->stamp;
    record(*bytes);
  } else if (auto* note = std::get_if<JournalNote>(&item)) {
    // A journal note may stand anywhere among the bytes, because it names the scan that it belongs to.
    ByteRecord noted;
    noted.stamp = last_stamp_;
    noted.note = std::move(*note);
    record(noted);
  } else if (const auto* point = std::get_if<TrajectoryPoint>(&item)) {
    if (trajectory_) trajectory_->write(tum_line(*point), now_);
  } else if (const auto* row = std::get_if<std::unique_ptr<const LocalizationRow>>(&item)) {
    if (localization_) localization_->write(csv_line(**row), now_);
    if (listener_) listener_->hear(**row, now_);
  } else if (const auto* pose = std::get_if<std::unique_ptr<const KeptPose>>(&item)) {
    memory_.keep(**pose, now_);
  } else if (const auto* stability = std::get_if<std::unique_ptr<const KeptStability>>(&item)) {
    memory_.keep(**stability, now_);
  } else if (const auto* order = std::get_if<std::unique_ptr<const SaveOrder>>(&item)) {
    save(**order);
  } else if (const auto* wanted = std::get_if<RecordOrder>(&item)) {
    obey(*wanted);
  } else if (const auto* mark = std::get_if<std::unique_ptr<const MarkOrder>>(&item)) {
    keep(**mark);
  } else if (const auto* edit = std::get_if<std::unique_ptr<const SiteEditOrder>>(&item)) {
    if (hooks_.draw && hooks_.saved) hooks_.saved(hooks_.draw(**edit));
  } else if (auto* checkpoint = std::get_if<std::shared_ptr<const Checkpoint>>(&item)) {
    if (recording_) recording_->begin_part(**checkpoint, now_);
    if (listener_) listener_->hear(std::move(*checkpoint), now_);
  } else {
    const auto& line = std::get<LogLine>(item);
    (line.is_warning ? hooks_.warn : hooks_.log)(line.text);
  }
}

void Recorder::save(const SaveOrder& order) {
  const control::CommandOutcome outcome = memory_.save(order);
  if (hooks_.saved) hooks_.saved(outcome);
}

void Recorder::obey(const RecordOrder& order) {
  control::CommandOutcome outcome{order.ticket, true, ""};
  try {
    if (!recording_) throw std::runtime_error("'recording.file' is not set: " + std::string(kOnlyFromTheStart));
    outcome.message = order.goes_on ? recording_->start(now_) : recording_->stop(now_);
  } catch (const std::runtime_error& error) {
    outcome = {order.ticket, false, error.what()};
  }
  if (hooks_.saved) hooks_.saved(outcome);
}

void Recorder::keep(const MarkOrder& mark) {
  const control::CommandOutcome outcome = listener_ ? listener_->hear(mark, drivers::port::port_clock_now())
                                                    : control::CommandOutcome{mark.ticket, false, kNothingIsKept};
  if (hooks_.saved) hooks_.saved(outcome);
}

void Recorder::record(const ByteRecord& record) {
  if (recording_) recording_->write(record, now_);
  if (listener_) listener_->hear(record, now_);
}

void Recorder::flush() {
  now_ = drivers::port::port_clock_now();
  if (trajectory_) trajectory_->flush(now_);
  if (localization_) localization_->flush(now_);
  memory_.retry(now_);
  const std::uint64_t all = refused();
  const bool lost_some = all != std::exchange(refused_before_, all);
  if (lost_some && listener_) listener_->hear_of_loss();
  if (!recording_) return;
  if (lost_some) recording_->note_loss();
  recording_->flush(now_);
}

}  // namespace deltamap::daemon
