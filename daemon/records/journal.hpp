// SPDX-License-Identifier: Apache-2.0
// The scheduling journal. Live, the moment at which a revision arrives or a queue overflows depends on the CPU, and an
// operator may step in; each such decision is written into the recording as a note, and a replay that starts from the
// same settings and map obeys it, so that it comes to the same trajectory, revisions and Δ-phases.
#pragma once

#include <compare>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/geometry/pose2.hpp"
#include "core/messages.hpp"
#include "daemon/records/map_order.hpp"
#include "daemon/records/site_note.hpp"

namespace deltamap::daemon {

/// What a run begins from; a replay obeys a journal only where all of it is equal.
struct RunIdentity {
  std::uint64_t settings = 0;  ///< settings_fingerprint(), which holds seed and initial pose too
  std::uint64_t map = 0;       ///< grid_hash() of the map that the run starts on
  std::uint64_t memory = 0;    ///< of what an earlier run has left besides (pose, stability); 0: nothing
  friend bool operator==(const RunIdentity&, const RunIdentity&) = default;
};

struct Decision {
  enum class Kind : std::uint8_t {
    kRevision,      ///< revision `number` taken before scan `scan`
    kTransients,    ///< snapshot `number` of the transient layer taken before scan `scan`
    kScanDropped,   ///< overtaken by a newer one; it has a line in the trajectory, predicted by odometry
    kScanLost,      ///< found the sensor channel full: nobody saw it
    kOdometryLost,  ///< odometry number `number` found the sensor channel full
    kTrackedLost,   ///< scan `scan` was localized and found the tracked channel full
    kSetLost,       ///< S(k) of Δ-phase `number` found the map thread busy for too long
    kPhaseClosed,   ///< Δ-phase `number` ended at scan `scan`
    kPaused,        ///< by the operator: Δ-mapping does not see scan `scan` and those after it
    kResumed,       ///< by the operator: it sees scan `scan` again
    kRelocalized,   ///< by the operator: to `map_from_robot` before scan `scan`
    kMapSet,        ///< by the operator: the cells `set` before scan `scan`
    kSiteSet        ///< by the operator: bays and zones are those of `site` from scan `scan` on
  } kind = Kind::kRevision;
  std::uint32_t scan = 0;
  std::uint32_t number = 0;
  Pose2 map_from_robot{};
  /// Of an operator's command: Scan.time of `scan`. Nothing in recordings of older versions.
  std::optional<Timestamp> scan_time{};
  std::shared_ptr<const SetCells> set{};  ///< of kMapSet; else null
  SharedSite site{};                      ///< of kSiteSet; else null
  friend bool operator==(const Decision&, const Decision&) = default;
};

[[nodiscard]] std::string note_of(const RunIdentity& run);
/// Of any kind but kMapSet and kSiteSet, which take several notes (map_order, site_note).
[[nodiscard]] std::string note_of(const Decision& decision);
[[nodiscard]] std::optional<RunIdentity> run_of_note(std::string_view note);
[[nodiscard]] std::optional<Decision> decision_of_note(std::string_view note);

/// The note that stands where records are missing: the disk was full or too slow.
inline constexpr std::string_view kGapNote = "records lost here";

/// A recording that begins in mid-run: behind the first of these notes stands what the devices had said before
/// (run_so_far.hpp), behind the second what they said from then on.
inline constexpr std::string_view kEarlierNote = "said before this part of the run";
inline constexpr std::string_view kPartNote = "this part of the run begins";

/// All decisions of one recording.
class Journal {
 public:
  /// Any note of a recording, in order; those of other kinds are passed over. A new run forgets the one before.
  void read(std::string_view note);

  /// Some of its notes, or bytes beside them, are missing.
  void lose_records() { has_gap_ = true; }

  [[nodiscard]] const std::optional<RunIdentity>& run() const { return run_; }
  /// Bytes or decisions of this run are missing: nothing can be reproduced bit by bit.
  [[nodiscard]] bool has_gap() const { return has_gap_; }
  /// The recording begins in mid-run: it counts other scans than the run did.
  [[nodiscard]] bool is_part() const { return is_part_; }
  /// The newest revision to be taken before the scan; nothing where none is.
  [[nodiscard]] std::optional<std::uint32_t> revision_before(std::uint32_t scan) const;
  /// The number of the newest transient layer to be taken before the scan; nothing where none is.
  [[nodiscard]] std::optional<std::uint32_t> transients_before(std::uint32_t scan) const;
  [[nodiscard]] bool was_dropped(std::uint32_t scan) const { return dropped_.contains(scan); }
  [[nodiscard]] bool was_lost(std::uint32_t scan) const { return lost_.contains(scan); }
  [[nodiscard]] bool odometry_was_lost(std::uint32_t number) const { return lost_odometry_.contains(number); }
  [[nodiscard]] bool tracked_was_lost(std::uint32_t scan) const { return lost_tracked_.contains(scan); }
  [[nodiscard]] bool set_was_lost(std::uint32_t phase) const { return lost_sets_.contains(phase); }
  /// The scan at which a Δ-phase ended in the recorded run.
  [[nodiscard]] std::optional<std::uint32_t> closing_scan(std::uint32_t phase) const;
  [[nodiscard]] std::size_t closed_phases() const { return closed_.size(); }
  /// What the operator asked for, in the order of the scans before which it was done.
  [[nodiscard]] const std::vector<Decision>& commands() const { return commands_; }
  /// Whether a command was done before this scan (equal), before an earlier (less) or a later one (greater). Where
  /// records are missing a replay counts fewer scans than the run did: there the time of its scan places a command.
  [[nodiscard]] std::strong_ordering place_of(const Decision& command, const Scan& scan) const;

 private:
  void take(const Decision& decision);
  [[nodiscard]] bool is_repeated(const Decision& command) const;
  void add_command(Decision command);

  std::optional<RunIdentity> run_;
  bool has_gap_ = false;
  bool is_part_ = false;
  std::map<std::uint32_t, std::uint32_t> revisions_;   // scan → revision
  std::map<std::uint32_t, std::uint32_t> transients_;  // scan → snapshot
  std::map<std::uint32_t, std::uint32_t> closed_;      // phase → scan
  std::vector<Decision> commands_;
  SetCellsReader set_cells_;
  SetSiteReader set_site_;
  std::set<std::uint32_t> dropped_, lost_, lost_odometry_, lost_tracked_, lost_sets_;
};

}  // namespace deltamap::daemon
