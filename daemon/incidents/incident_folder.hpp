// SPDX-License-Identifier: Apache-2.0
// One incident on disk. Its folder comes into being whole: it is written aside, synced and renamed. What comes after is
// appended to its recording, and the page is replaced whole: whenever the daemon is killed, there is an incident that
// replays, or none.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include "core/grid/occupancy_grid.hpp"
#include "daemon/incidents/incident.hpp"
#include "daemon/settings/settings.hpp"
#include "drivers/port/byte_log.hpp"

namespace deltamap::daemon {

class IncidentFolder {
 public:
  using TakeRecord = std::function<void(const drivers::port::ByteRecord&)>;
  struct Content {
    Incident incident;     ///< its name is made here; with `to` where nothing will come after `records`
    std::string settings;  ///< YAML: to replay it with
    std::shared_ptr<const OccupancyGrid> map;
    drivers::port::FirstBauds bauds;
    std::string log;
    std::function<void(const TakeRecord&)> records;  ///< all up to now
  };
  /// Throws std::runtime_error naming file and reason; nothing is there then.
  IncidentFolder(const std::filesystem::path& parent, Content content);

  // These throw std::runtime_error naming the file; what is on disk stays whole.

  void write(const drivers::port::ByteRecord& record) { writer_->write(record); }
  void flush() { writer_->flush(); }
  void add(const IncidentEvent& event);
  /// Its last record came at this time.
  void finish(Timestamp to, const std::string& log);

  [[nodiscard]] const Incident& incident() const { return incident_; }
  [[nodiscard]] const std::filesystem::path& path() const { return folder_; }

 private:
  Incident incident_;
  std::filesystem::path folder_;
  std::unique_ptr<drivers::port::ByteLogWriter> writer_;
};

/// The incident's facts and its page in words, each replaced whole. Throws std::runtime_error naming the file.
void write_page(const std::filesystem::path& folder, const Incident& incident);

/// An incident that was not whole when the daemon was killed; nothing: none.
[[nodiscard]] std::optional<std::filesystem::path> draft_in(const std::filesystem::path& parent);
/// Nobody meets half of it: it goes out of the way first. Nothing where it went, else why not.
std::error_code remove_at_once(const std::filesystem::path& folder);

/// What a daemon that was killed has left half written, or half removed.
void remove_drafts(const std::filesystem::path& parent);

/// Ends of the daemon that are kept at most, so that one that cannot live drives out nothing else.
inline constexpr std::size_t kMostEnds = 10;

/// Incidents that are not pinned go until the others are within the limits: the oldest first of those that neither a
/// person has marked nor a lost or carried pose has made, then the oldest of these; `newest` stays in any case. A line
/// for each that has gone.
[[nodiscard]] std::vector<std::string> within_limits(const IncidentSettings& settings, const std::string& newest);

}  // namespace deltamap::daemon
