// SPDX-License-Identifier: Apache-2.0
// What an LMS200 and a P3-DX would have sent for the scans and poses of a CARMEN log (docs/protocols/README.md,
// CARMEN logs).
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "core/geometry/pose2.hpp"
#include "core/time.hpp"
#include "drivers/carmen/carmen_log.hpp"
#include "drivers/carmen/carmen_survey.hpp"
#include "drivers/lms200/measurement.hpp"
#include "drivers/port/byte_record.hpp"

namespace deltamap::drivers::carmen {

inline constexpr unsigned kImportBaud = 500'000;  // nominal, for both ports; the line itself is not modelled

/// One scan as the words of the nearest variant. Bearings that the scan does not have are "not valid" (…FFFh).
[[nodiscard]] drivers::lms200::Measurement measurement_of(const CarmenScan& scan, const CarmenSurvey& survey);

/// Puts poses and scans in the order in which they would have arrived, one telegram a record, stamped so that the
/// decoders give back the log's times. Stamps never go backwards unless the log does.
class CarmenBytes {
 public:
  using Sink = std::function<void(const drivers::port::ByteRecord&)>;
  CarmenBytes(const CarmenSurvey& survey, Sink sink);

  /// A pose of the robot at a time: one packet, and others in between where the last is more than 100 ms ago.
  void add_pose(Timestamp time, const Pose2& odom_from_robot);
  /// A scan whose first beam was measured at its time; its pose must have been added before.
  void add_scan(const CarmenScan& scan);
  /// Nothing more comes.
  void finish();

  [[nodiscard]] std::size_t poses() const { return poses_; }
  /// Pauses too long to be filled with poses: the odometry begins anew after them.
  [[nodiscard]] std::size_t gaps() const { return gaps_; }

 private:
  void greet(Timestamp first_time);
  void send_scans_until(Timestamp stamp);
  void send_pose(Timestamp time, const Pose2& pose, double speed_m_per_s, double turn_rate_rad_per_s);

  const CarmenSurvey& survey_;
  Sink sink_;
  std::vector<drivers::port::ByteRecord> waiting_scans_;  // by stamp
  std::optional<TimedPose> last_pose_;
  bool greeted_ = false;
  std::size_t poses_ = 0;
  std::size_t gaps_ = 0;
};

}  // namespace deltamap::drivers::carmen
