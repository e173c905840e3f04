// SPDX-License-Identifier: Apache-2.0
// What a run has seen of the bays, for the next one: that shows it, as old as it is, until it has looked itself.
// Nothing is judged by it, so a replay needs none of it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "daemon/outputs/bays_board.hpp"

namespace deltamap::daemon {

/// As a file. `first_map`: grid_hash() of the map that the bays lie on.
[[nodiscard]] std::string kept_text(const BayList& list, std::uint64_t first_map);
/// None of another map, of no such text, and of what was seen later than `now`: the clock was another one.
[[nodiscard]] BayList bays_of_kept_text(std::string_view text, std::uint64_t first_map, Timestamp now);

class RememberedBays {
 public:
  RememberedBays() = default;
  explicit RememberedBays(BayList list) : list_{std::move(list)} {}

  /// Puts what is remembered in the place of what this run has never known, of bays of the same id and corners. What it
  /// has known once is never remembered again.
  [[nodiscard]] std::shared_ptr<const BayList> beside(const BayList& known);

 private:
  BayList list_;
};

/// What the run before has left there; nothing where there is none.
[[nodiscard]] RememberedBays remembered_bays(const std::filesystem::path& file, std::uint64_t first_map, Timestamp now);

}  // namespace deltamap::daemon
