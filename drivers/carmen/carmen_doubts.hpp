// SPDX-License-Identifier: Apache-2.0
// What an import leaves out, fills in or doubts, and where the log has its laser: gathered from its scans, one line
// each.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/pose2.hpp"
#include "drivers/carmen/carmen_log.hpp"

namespace deltamap::drivers::carmen {

class CarmenDoubts {
 public:
  /// A scan that is imported.
  void add(const CarmenScan& scan);

  /// Where the scan lines have the laser on the robot; nothing where they do not agree, or carry no poses.
  [[nodiscard]] std::optional<Pose2> robot_from_laser() const;
  /// One line each; `faults` are those of the whole log.
  [[nodiscard]] std::vector<std::string> lines(const CarmenFaults& faults) const;

 private:
  struct Beams {
    std::size_t scans = 0;
    std::size_t all = 0;
    std::size_t beyond = 0;  ///< the fan of the variant
    std::size_t missing = 0;
    double step_deg = 0.0;
    double variant_step_deg = 0.0;
    double half_deg = 0.0;  ///< of the variant's fan
  };
  void add_beams_of(const CarmenScan& scan);
  void add_ranges_of(const CarmenScan& scan);
  [[nodiscard]] std::string far_line() const;
  [[nodiscard]] std::string mount_line(const StatedMount& stated) const;

  std::vector<Beams> beams_;  // one entry for each shape of scan
  struct Mount {
    std::size_t line = 0;
    Pose2 robot_from_laser;
  };
  std::vector<Mount> mounts_;
  std::size_t scans_ = 0;
  std::size_t far_scans_ = 0;  // with ranges that no scanner measures
  std::size_t first_far_line_ = 0;
  std::size_t not_numbers_ = 0;
  std::map<std::size_t, std::size_t> guessed_fields_;  // scans by the number of their values
};

}  // namespace deltamap::drivers::carmen
