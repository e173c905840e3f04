// SPDX-License-Identifier: Apache-2.0
// What the drivers make of a recording, message by message: read from the file by one replay, or kept in memory for
// many (recorded_drive.hpp).
#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "core/messages.hpp"
#include "daemon/outputs/outputs.hpp"
#include "daemon/records/recording_decoder.hpp"
#include "daemon/settings/settings.hpp"
#include "drivers/port/replay_port.hpp"

namespace deltamap::daemon {

struct RecordedMessage {
  SensorMessage message;
  std::uint32_t number = 0;  ///< counts odometry, or scans, from 0 as the live daemon does
};

class MessageSource {
 public:
  virtual ~MessageSource() = default;
  /// The next one of the window, in order of arrival; nothing at the end. Throws as ByteLogReader does.
  [[nodiscard]] virtual std::optional<RecordedMessage> next() = 0;
  /// Share of the recording that has been handed over, 0 to 1.
  [[nodiscard]] virtual double done() const = 0;
  /// At the end: what the recording lacks, and decoder counts by device and cause.
  [[nodiscard]] virtual drivers::port::LogFaults faults() const = 0;
  [[nodiscard]] virtual std::map<std::string, std::uint64_t> wire() const = 0;
  /// At the end, and once: what of the recording lies outside the window. Reads on to the recording's end.
  [[nodiscard]] virtual OutsideWindow outside_window() = 0;
};

/// Reads while it goes on: its memory does not grow with the recording.
class FileMessages : public MessageSource {
 public:
  /// `settings`: of robot and laser. Throws as ByteLogReader does.
  FileMessages(const std::filesystem::path& recording, const drivers::port::ReplayWindow& window,
               const Settings& settings);

  [[nodiscard]] std::optional<RecordedMessage> next() override;
  [[nodiscard]] double done() const override;
  [[nodiscard]] drivers::port::LogFaults faults() const override { return port_.faults(); }
  [[nodiscard]] std::map<std::string, std::uint64_t> wire() const override { return decoder_.counts(); }
  [[nodiscard]] OutsideWindow outside_window() override;

 private:
  /// False at the end.
  [[nodiscard]] bool read_on();

  drivers::port::ReplayPort port_;
  RecordingDecoder decoder_;
  std::deque<RecordedMessage> waiting_;
  std::uint64_t scans_before_ = 0;
};

}  // namespace deltamap::daemon
