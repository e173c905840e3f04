// SPDX-License-Identifier: Apache-2.0
// Which fan a laser of the LMS2xx family sweeps (protocols.md B3 command 3Bh, B6, B7): its angle and the step between
// beams.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace deltamap::drivers::lms200 {

/// One turn of the mirror, 75 Hz (B7).
inline constexpr double kMirrorTurnS = 0.01332;

struct ScanVariant {
  std::uint16_t angle_deg = 180;            ///< 90, 100 or 180
  std::uint16_t resolution_centideg = 100;  ///< 25, 50 or 100
  friend bool operator==(const ScanVariant&, const ScanVariant&) = default;

  [[nodiscard]] unsigned values() const { return 100u * angle_deg / resolution_centideg + 1; }
  /// Turns of the mirror that one scan takes: 1 degree a turn, the rasters between follow. The LMS291-S14 measures its
  /// 90 degrees in one turn.
  [[nodiscard]] unsigned turns() const { return angle_deg == 90 ? 1u : 100u / resolution_centideg; }
  [[nodiscard]] double scan_duration_s() const { return turns() * kMirrorTurnS; }
  /// Of value 0, in the scanner's own sense: 0 is right, 90 ahead.
  [[nodiscard]] double first_angle_deg() const { return (180.0 - angle_deg) / 2.0; }
};

/// Five that an LMS200, 211, 221 or 291 can be set to, and the only one of the LMS291-S14, 90/0.5; 180/0.25 is none.
[[nodiscard]] bool is_possible(const ScanVariant& variant);
/// "180/1", "180/0.5", "100/1", "100/0.5", "100/0.25", "90/0.5".
[[nodiscard]] std::optional<ScanVariant> variant_named(std::string_view name);
[[nodiscard]] std::string name_of(const ScanVariant& variant);
/// The number of values tells the variant (B6), but for 181, which 90/0.5 has as well: 180/1 is answered.
[[nodiscard]] std::optional<ScanVariant> variant_with_values(unsigned values);

}  // namespace deltamap::drivers::lms200
