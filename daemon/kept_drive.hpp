// SPDX-License-Identifier: Apache-2.0
// The drive switch on disk (drivers/pioneer/drive_permission): what a person switched off stays off across restarts.
// A small file beside map.store, replaced whole and synced the moment the switch changes. Missing, damaged or without
// a place to be kept: unknown, and unknown is off.
#pragma once

#include <filesystem>
#include <string>

#include "drivers/pioneer/drive_permission.hpp"

namespace deltamap::daemon {

class KeptDrive {
 public:
  using DriveSwitch = drivers::pioneer::DriveSwitch;

  /// Empty: no place to keep it.
  explicit KeptDrive(std::filesystem::path file);

  [[nodiscard]] DriveSwitch value() const { return value_; }
  /// Why a file that is there could not be used; else empty.
  [[nodiscard]] const std::string& why_unknown() const { return why_unknown_; }

  /// On disk when it returns. A switch that cannot be written is taken off the disk, where it is not on. Answers a line
  /// to be logged where it could not be kept.
  [[nodiscard]] std::string keep(DriveSwitch value);

 private:
  std::filesystem::path file_;
  DriveSwitch value_ = DriveSwitch::kUnknown;
  std::string why_unknown_;
};

}  // namespace deltamap::daemon
