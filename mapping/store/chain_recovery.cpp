// SPDX-License-Identifier: Apache-2.0
#include "mapping/store/chain_recovery.hpp"

#include <algorithm>
#include <utility>

#include "mapping/store/history.hpp"
#include "mapping/store/map_codec.hpp"

namespace deltamap::mapping::store {
namespace {

std::vector<CellChange> reversed(std::vector<CellChange> changes) {
  for (CellChange& change : changes) std::swap(change.before, change.after);
  return changes;
}

class Chain {
 public:
  explicit Chain(const ChainParts& parts) : parts_{parts} {}

  std::vector<std::uint32_t> remake() {
    std::size_t next = begin();
    while (next < parts_.steps.size()) next = follows(next) ? next + 1 : over_the_hole(next);
    std::sort(lost_.begin(), lost_.end());
    lost_.erase(std::unique(lost_.begin(), lost_.end()), lost_.end());
    return std::move(lost_);
  }

 private:
  /// At the first whole map; answers the step behind it.
  std::size_t begin() {
    for (std::size_t i = 0; i < parts_.steps.size(); ++i) {
      auto grid = parts_.grid(i);
      if (!grid) {
        lost_.push_back(parts_.steps[i].number);
        continue;
      }
      map_ = *std::move(grid);
      number_ = parts_.steps[i].number;
      parts_.made({.number = number_, .step = i, .needs_grid = true}, map_);
      return i + 1;
    }
    return parts_.steps.size();
  }

  void make(MadeStep made, OccupancyGrid map) {
    made.needs_grid = made.needs_grid || made.number != number_ + 1;
    map_ = std::move(map);
    number_ = made.number;
    std::erase(lost_, number_);  // its row was passed over, and it follows from a later one
    parts_.made(made, map_);
  }

  std::optional<std::vector<CellChange>> changes_of(std::size_t i) const {
    return decoded_changes(parts_.steps[i].changes, parts_.geometry);
  }

  /// Makes the step that leads on from the map so far; false where it does not.
  bool follows(std::size_t i) {
    const ChainStep& step = parts_.steps[i];
    const auto changes = changes_of(i);
    const bool is_next = step.number == number_ + 1;
    if (is_exact_ && changes) {
      OccupancyGrid next = patched(map_, *changes);
      const bool is_certain = step.is_sure && is_next;  // its hash need not be asked
      if (is_certain || signed_hash(next) == step.hash) {
        make({.number = step.number, .step = i, .needs_grid = step.has_grid}, std::move(next));
        return true;
      }
    }
    if (!is_next) return false;
    if (auto grid = parts_.grid(i)) {  // whatever its changes are
      is_exact_ = true;
      make_between(i, *std::move(grid), true);
      return true;
    }
    if (is_exact_ || !changes) return false;
    // Without what is lost; as soon as nothing of that shows any more it is right again.
    OccupancyGrid next = patched(map_, *changes);
    is_exact_ = signed_hash(next) == step.hash;
    make_between(i, std::move(next), false);
    return true;
  }

  void make_between(std::size_t i, OccupancyGrid next, bool has_grid) {
    std::vector<CellChange> changes = changes_between(map_, next);
    make({.number = parts_.steps[i].number,
          .step = i,
          .is_as_it_was = false,
          .changes = std::move(changes),
          .needs_grid = has_grid,
          .lacks_something = !is_exact_},
         std::move(next));
  }

  /// What lies before the next usable step is damaged or missing; answers the step to go on with.
  std::size_t over_the_hole(std::size_t i) {
    const ChainStep& found = parts_.steps[i];
    const bool is_missing = found.number != number_ + 1;
    const std::size_t next = is_missing ? i : i + 1;
    if (next == parts_.steps.size()) {
      lost_.push_back(found.number);
      return next;
    }
    const std::uint32_t last = parts_.steps[next].number - 1;
    auto before = map_before(next);
    is_exact_ = before.has_value();
    for (std::uint32_t number = number_ + 1; number < last; ++number) lost_.push_back(number);
    if (!before) {
      if (last > number_) lost_.push_back(last);
      leave_out(next);
      return next + 1;
    }
    std::vector<CellChange> changes = changes_between(map_, *before);
    make({.number = last,
          .step = is_missing ? std::nullopt : std::optional{i},
          .is_as_it_was = false,
          .changes = std::move(changes),
          .is_computed = true},
         *std::move(before));
    return next;
  }

  /// Exactly, or not at all.
  std::optional<OccupancyGrid> map_before(std::size_t next) {
    if (auto before = back_from_a_whole_map(next)) return before;
    const auto changes = changes_of(next);
    if (!changes) return std::nullopt;
    OccupancyGrid before = as_later_steps_tell(next);
    if (signed_hash(patched(before, *changes)) != parts_.steps[next].hash) return std::nullopt;
    return before;
  }

  std::optional<OccupancyGrid> back_from_a_whole_map(std::size_t next) {
    std::size_t i = next;
    std::optional<OccupancyGrid> grid;
    while (i < parts_.steps.size() && !(grid = parts_.grid(i))) ++i;
    for (; grid; --i) {
      const auto changes = changes_of(i);
      if (!changes) return std::nullopt;
      grid = patched(*std::move(grid), reversed(*changes));
      if (i == next) return grid;
      if (signed_hash(*grid) != parts_.steps[i - 1].hash) return std::nullopt;
    }
    return std::nullopt;
  }

  /// The map so far, but for the cells of which a later step tells what they were before it.
  OccupancyGrid as_later_steps_tell(std::size_t next) const {
    OccupancyGrid before = map_;
    OccupancyGrid told{parts_.geometry};  // free: something has been told of the cell
    for (std::size_t i = next; i < parts_.steps.size(); ++i) {
      const auto changes = changes_of(i);
      if (!changes || (i > next && parts_.steps[i].number != parts_.steps[i - 1].number + 1)) break;
      for (const CellChange& change : *changes) {
        if (told[change.cell] == CellState::kFree) continue;
        told.set(change.cell, CellState::kFree);
        before.set(change.cell, change.before);
      }
    }
    return before;
  }

  /// The step goes on without what is lost before it.
  void leave_out(std::size_t next) {
    const auto changes = changes_of(next);
    if (!changes) {
      lost_.push_back(parts_.steps[next].number);
      return;
    }
    make_between(next, patched(as_later_steps_tell(next), *changes), false);
  }

  const ChainParts& parts_;
  OccupancyGrid map_;
  std::uint32_t number_ = 0;
  bool is_exact_ = true;  // map_ is M_k, bit for bit
  std::vector<std::uint32_t> lost_;
};

}  // namespace

std::vector<std::uint32_t> remake_chain(const ChainParts& parts) { return Chain{parts}.remake(); }

}  // namespace deltamap::mapping::store
