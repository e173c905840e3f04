// SPDX-License-Identifier: Apache-2.0
// Who hears, in the recorder thread, all that comes there: the keeper of incidents.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "daemon/control/command.hpp"
#include "daemon/outputs/localization_log.hpp"
#include "daemon/records/checkpoint.hpp"
#include "drivers/port/byte_record.hpp"

namespace deltamap::daemon {

/// What an order for incidents is told where none are kept.
inline constexpr const char* kNothingIsKept = "'incidents.folder' is not set: nothing is kept (set it, and restart)";

/// `ctl mark`: a person wants this moment kept.
struct MarkOrder {
  std::string words;  ///< one line; may be empty
  std::uint64_t ticket = 0;
};

class RunListener {
 public:
  virtual ~RunListener() = default;

  virtual void hear(const drivers::port::ByteRecord& record, Timestamp now) = 0;
  /// Some records never came.
  virtual void hear_of_loss() = 0;
  virtual void hear(const LocalizationRow& row, Timestamp now) = 0;
  virtual void hear(std::shared_ptr<const Checkpoint> checkpoint, Timestamp now) = 0;
  [[nodiscard]] virtual control::CommandOutcome hear(const MarkOrder& mark, Timestamp now) = 0;
  /// Many times a second, whatever has come.
  virtual void look(Timestamp now) = 0;
  /// The run ends.
  virtual void close(Timestamp now) = 0;
};

}  // namespace deltamap::daemon
