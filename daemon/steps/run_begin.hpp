// SPDX-License-Identifier: Apache-2.0
// What a recorded run began from besides M_0 and its settings: M_k and what of it is provisional, the pose that was
// kept, what had proven stable, what was known of wheels and mount. It stands in the recording itself, as notes after
// the first one, so that one file is all that a replay needs.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "daemon/records/checkpoint.hpp"
#include "daemon/records/note_parts.hpp"
#include "daemon/settings/settings.hpp"
#include "daemon/steps/localization_step.hpp"

namespace deltamap::daemon {

struct RunBegin {
  std::uint64_t first_map = 0;  ///< grid_hash() of M_0
  std::uint64_t memory = 0;     ///< RunIdentity::memory
  StartMap start;               ///< its map is null where the run began on M_0 itself
};

/// Empty where the run began from M_0 alone. Each note fits a pcapng comment.
[[nodiscard]] std::vector<std::string> begin_notes(const RunBegin& begin);

/// What a run begins from: enough for a replay to obey its journal; and, for people, every setting that is not as
/// delivered. `map`: grid_hash() of the map it begins on.
[[nodiscard]] std::vector<std::string> first_notes(const Settings& settings, std::uint64_t map, const RunBegin& begin);

/// What the localizer knows behind its newest scan, which was tracked on this map.
[[nodiscard]] Checkpoint checkpoint_of(const LocalizationStep& step, std::uint64_t first_map,
                                       std::shared_ptr<const OccupancyGrid> map);

/// first_notes() of a recording that begins in mid-run: what is known at the checkpoint. Of the localizer that is the
/// pose with its deviation, not the particles; votes and transient obstacles begin anew.
[[nodiscard]] std::vector<std::string> part_notes(const Settings& settings, const Checkpoint& from);
/// The settings to replay it with: the pose that the run was given is that of another time.
[[nodiscard]] Settings settings_of_a_part(Settings settings);

/// Key and value of such a setting; nothing for any other note.
[[nodiscard]] std::optional<std::pair<std::string, std::string>> setting_of_note(std::string_view note);

/// Puts the notes of one recording together again.
class BeginReader {
 public:
  BeginReader();
  /// Any note, in order; those of other kinds are passed over. The first part of another run forgets the one before.
  void read(std::string_view note);
  /// A new run: what was read belongs to the one before.
  void forget() { *this = {}; }

  /// Some notes were there, and not all, or they are damaged.
  [[nodiscard]] bool is_incomplete() const { return parts_.has_begun() && !begin_; }
  [[nodiscard]] const std::optional<RunBegin>& begin() const { return begin_; }

 private:
  PartsReader parts_;
  std::optional<RunBegin> begin_;
};

}  // namespace deltamap::daemon
