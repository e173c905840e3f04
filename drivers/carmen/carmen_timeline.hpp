// SPDX-License-Identifier: Apache-2.0
// The times of a log's records one after another: where its clock was set back, or set forward by the logger's own
// times, they go on, and scans that repeat a stamp are set apart by the logger's times, where it has them.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/time.hpp"
#include "drivers/carmen/carmen_line.hpp"

namespace deltamap::drivers::carmen {

class CarmenTimeline {
 public:
  struct Placed {
    Timestamp time;
    bool is_repeated = false;  ///< a scan whose time is not after that of the scan before
  };
  struct ScanKind {
    std::string_view name;  ///< of its line
    bool has_poses = false;
  };
  /// The next line of the log, with the time that the log's clock tells; `scan` where it is one. A record may come up
  /// to a second late, as logs have them whose messages crossed. Scans with and without poses are told apart: many logs
  /// have each sweep as both; of two kinds that carry poses the second of one stamp is the same sweep once more.
  [[nodiscard]] Placed place(Timestamp told, const CarmenTimes& times, const std::optional<ScanKind>& scan,
                             std::size_t line);

  /// One line for each kind of step of the clock that was met.
  [[nodiscard]] std::vector<std::string> clock_notes() const;
  /// One line each for scans that were set apart and for those that are left out.
  [[nodiscard]] std::vector<std::string> repeat_notes() const;

 private:
  struct Seen {
    std::size_t count = 0;
    std::size_t first_line = 0;
    Duration farthest{0};
    void add(std::size_t line, Duration far = Duration{0}) {
      first_line = count++ == 0 ? line : first_line;
      farthest = std::max(farthest, far);
    }
    /// "2 times (the first in line 7), by up to 3600 s"
    [[nodiscard]] std::string words() const;
  };
  void take_steps_out(Timestamp told, const CarmenTimes& times, std::size_t line);
  struct LastScan {
    Timestamp time;
    std::optional<Duration> logger;
    std::string kind;
  };
  /// Since the record before, by the logger's times; nothing where these do not go on.
  [[nodiscard]] std::optional<Duration> passed_by_logger(const CarmenTimes& times) const;
  [[nodiscard]] bool has_steady_logger() const;
  [[nodiscard]] static Duration since(const LastScan& last, const CarmenTimes& times, const ScanKind& scan);

  Duration shift_{0};
  Duration shift_before_{0};
  std::optional<Timestamp> newest_;
  std::array<std::optional<LastScan>, 2> last_scans_;    // without poses, with poses
  std::optional<Duration> last_logger_;                  // of the last record
  std::optional<std::pair<Timestamp, Duration>> began_;  // by stamp and by logger: of the first record with both
  Seen set_back_;
  Seen set_forward_;
  Seen stepped_on_;  // a pause, or a clock that was set
  Seen set_apart_;
  Seen repeated_;
};

}  // namespace deltamap::drivers::carmen
