// SPDX-License-Identifier: Apache-2.0
// What was heard on a line whose device does not answer: nothing, garbage, or the other device, because the ports are
// swapped. A session feeds it every chunk that brought no frame of its own and adds its phrase to the reason it fails.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace deltamap::drivers {

enum class Device { kRobot, kLaser };

class LineDiagnosis {
 public:
  explicit LineDiagnosis(Device expected) : expected_{expected} {}

  /// Bytes that made no frame of the device that is expected.
  void hear(std::span<const std::uint8_t> bytes);
  void hear_own_frame() { heard_own_ = true; }
  /// A new search: what was heard before does not count.
  void reset();

  /// A whole frame of the other device with a right checksum has come.
  [[nodiscard]] bool is_swapped() const { return is_swapped_; }
  /// "no bytes came", "garbage came" with what that means, "the ports are swapped", or "it was heard".
  [[nodiscard]] std::string phrase() const;

  /// Asks a laser for its type (protocols.md B3): a short answer. To the robot's controller it is noise before a
  /// packet, which it skips (A4). There is no counterpart: whatever a Pioneer answers may also let it drive on.
  [[nodiscard]] static std::vector<std::uint8_t> question_to_a_laser();

 private:
  enum class Frame { kNone, kWhole, kMayFollow };
  [[nodiscard]] Frame other_frame_at(std::size_t begin) const;

  Device expected_;
  std::vector<std::uint8_t> recent_;  // where a frame of the other device may begin
  bool heard_any_ = false;
  bool heard_own_ = false;
  bool is_swapped_ = false;
};

}  // namespace deltamap::drivers
