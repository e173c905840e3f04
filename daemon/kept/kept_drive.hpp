// SPDX-License-Identifier: Apache-2.0
// The drive switch on disk (drivers/pioneer/drive_permission): what a person switched off stays off across restarts.
// One small file for each robot in the folder of map.store, replaced whole and synced the moment the switch changes.
// Missing, damaged, of another robot, or without a place to be kept: unknown, and unknown is off.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "core/time.hpp"
#include "daemon/system/spare_descriptor.hpp"
#include "drivers/pioneer/drive_permission.hpp"
#include "navigation/stop_reason.hpp"

namespace deltamap::daemon {

/// The robot is known by the path of its port: its switch holds whatever map it drives on.
struct DrivePlace {
  std::filesystem::path file;  ///< empty: no place to keep it
  std::string robot_port;      ///< absolute; stands in the file as well
};
/// ttyUSB0.drive.json for /dev/ttyUSB0, deltamap+robot.drive.json for /dev/deltamap/robot, in the folder of the store.
/// No two ports have the same name. No file where there is no store.
[[nodiscard]] DrivePlace drive_place(const std::filesystem::path& store, const std::string& robot_port);

struct KeptDriveAnswer {
  drivers::pioneer::DriveSwitch value = drivers::pioneer::DriveSwitch::kUnknown;
  std::string why_unknown;  ///< why a file that is there cannot be used; else empty
};
[[nodiscard]] KeptDriveAnswer read_kept_drive(const DrivePlace& place);

/// While a stop waits for a person, the next run waits for one as well.
[[nodiscard]] drivers::pioneer::DriveSwitch switch_to_keep(drivers::pioneer::DriveSwitch value,
                                                           navigation::StopReason waits_for);

class KeptDrive {
 public:
  using DriveSwitch = drivers::pioneer::DriveSwitch;

  /// Reads the switch. "On" is written anew, and is unknown where that fails: an "off" could not be written either.
  explicit KeptDrive(DrivePlace place);

  /// What is known to be on disk; without a place, what was last told.
  [[nodiscard]] DriveSwitch value() const { return known_.value; }
  /// Why a file that is there could not be used at the start; else empty.
  [[nodiscard]] const std::string& why_unknown() const { return known_.why_unknown; }

  /// On disk when it returns, unless why_not_kept() then tells why not: to be called again and again, it tries once a
  /// second. An old "on" is removed where no other switch can be written. Answers a line to be logged, mostly empty.
  [[nodiscard]] std::string keep(DriveSwitch value, Timestamp now);
  /// Empty: what keep() was last given is on disk, or there is no place.
  [[nodiscard]] const std::string& why_not_kept() const { return why_not_kept_; }

 private:
  [[nodiscard]] bool waits_to_try_again(DriveSwitch value, Timestamp now) const;
  void write(DriveSwitch value);

  DrivePlace place_;
  KeptDriveAnswer known_;
  bool is_certain_ = true;  // a write that failed may have gone halfway
  std::optional<DriveSwitch> failed_;
  Timestamp failed_at_{};
  std::string why_not_kept_;
  SpareDescriptor spare_;  // an off is kept also where nothing else can be opened
};

}  // namespace deltamap::daemon
