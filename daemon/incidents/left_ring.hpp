// SPDX-License-Identifier: Apache-2.0
// The ring of a daemon that was killed, as the next one finds it. Beside the segments (daemon/incidents/segment_ring)
// it holds the settings, the map that the run began on, and the newest pose and log lines.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/grid/occupancy_grid.hpp"
#include "daemon/incidents/incident.hpp"
#include "daemon/settings/settings.hpp"
#include "drivers/port/byte_log.hpp"

namespace deltamap::daemon {

// What a running daemon writes for it.

/// When its run begins. Throws std::runtime_error naming the file.
void write_run_facts(const std::filesystem::path& ring, const Settings& settings, const OccupancyGrid& map);
/// Now and then: what an incident that begins with the newest pose would say, and its log. Each file is replaced whole,
/// and not synced. Throws as above.
void write_newest(const std::filesystem::path& ring, const Incident& newest, const std::string& log);
/// The first record of a segment's beginning: what an incident that begins there would say.
[[nodiscard]] std::string facts_note(const Incident& incident);

class LeftRing {
 public:
  using TakeRecord = std::function<void(const drivers::port::ByteRecord&)>;
  /// Reads it once; whatever in it is damaged is left out. Never throws for what the files hold.
  explicit LeftRing(std::filesystem::path folder);

  /// Of its newest record that is whole; nothing: no record is.
  [[nodiscard]] std::optional<Timestamp> last() const { return last_; }
  /// What is missing of its records and why; empty: nothing that is known.
  [[nodiscard]] const std::string& lacks() const { return lacks_; }

  /// Where a recording may begin.
  struct Start {
    std::uint64_t segment = 0;
    Incident facts;                                    ///< with no event
    std::vector<drivers::port::ByteRecord> beginning;  ///< stands before the segment's records
    std::shared_ptr<const OccupancyGrid> map;
    std::string settings;  ///< YAML
  };
  /// The oldest that is whole; nothing: there is none.
  [[nodiscard]] std::optional<Start> oldest_start() const;
  /// Every record of this segment and the later ones, with a note where some are missing.
  void read_from(std::uint64_t segment, const TakeRecord& take) const;
  void read_all(const TakeRecord& take) const { read_from(0, take); }

  /// Pose and revision at the end; of `start` where that is not known.
  [[nodiscard]] Incident newest(const Start& start) const;
  /// When that pose was measured; nothing: it is not known.
  [[nodiscard]] std::optional<Timestamp> pose_time() const;
  /// Of the newest beginning that is whole; null: there is none.
  [[nodiscard]] std::shared_ptr<const OccupancyGrid> newest_map() const;
  /// Empty where there is none.
  [[nodiscard]] std::string log() const;

 private:
  void look_at(std::uint64_t number, bool is_last);
  [[nodiscard]] std::optional<Start> start_at(std::uint64_t number) const;
  [[nodiscard]] std::optional<Incident> newest_facts() const;

  std::filesystem::path folder_;
  std::vector<std::uint64_t> numbers_;  // of the segments, in order
  std::optional<Timestamp> last_;
  std::string lacks_;
};

}  // namespace deltamap::daemon
