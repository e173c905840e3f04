// SPDX-License-Identifier: Apache-2.0
#include "mapping/votes/redraw_queue.hpp"

#include <algorithm>
#include <utility>

namespace deltamap::mapping::votes {
namespace {

constexpr std::uint32_t kMostBetween = 40;  // keyframes: a surface may be met from its other side much later

}  // namespace

void RedrawQueue::forget(std::vector<Region>::iterator region) {
  for (const std::uint32_t index : region->look.blocks) --watchers_.to_write(geometry_.cell_of(index));
  regions_.erase(region);
}

void RedrawQueue::watch(const std::vector<std::uint32_t>& blocks, int margin_blocks, std::uint32_t first_ms) {
  if (blocks.empty() || params_.looks == 0 || params_.most_watched == 0) return;
  Region region{{{}, first_ms, false}, 0, params_.first_look, params_.looks};
  std::vector<std::uint32_t>& wide = region.look.blocks;
  for (const std::uint32_t index : blocks) {
    const Cell middle = geometry_.cell_of(index);
    for (int row = -margin_blocks; row <= margin_blocks; ++row) {
      for (int column = -margin_blocks; column <= margin_blocks; ++column) {
        const Cell block{middle.column + column, middle.row + row};
        if (geometry_.contains(block)) wide.push_back(static_cast<std::uint32_t>(geometry_.index_of(block)));
      }
    }
  }
  std::sort(wide.begin(), wide.end());
  wide.erase(std::unique(wide.begin(), wide.end()), wide.end());
  if (regions_.size() >= params_.most_watched) forget(regions_.begin());
  for (const std::uint32_t index : wide) ++watchers_.to_write(geometry_.cell_of(index));
  regions_.push_back(std::move(region));
}

void RedrawQueue::begin_anew(const std::vector<std::uint32_t>& blocks, std::uint32_t now_ms) {
  for (Region& region : regions_) {
    const std::vector<std::uint32_t>& own = region.look.blocks;
    const bool overlaps = std::any_of(blocks.begin(), blocks.end(), [&](std::uint32_t index) {
      return std::binary_search(own.begin(), own.end(), index);
    });
    if (overlaps) region.look.first_ms = now_ms;
  }
}

void RedrawQueue::forget(const std::vector<std::uint32_t>& blocks) {
  for (auto region = regions_.begin(); region != regions_.end();) {
    std::erase_if(region->look.blocks, [&](std::uint32_t index) {
      const bool is_forgotten = std::binary_search(blocks.begin(), blocks.end(), index);
      if (is_forgotten) --watchers_.to_write(geometry_.cell_of(index));
      return is_forgotten;
    });
    region = region->look.blocks.empty() ? regions_.erase(region) : region + 1;
  }
}

void RedrawQueue::see(std::vector<std::uint32_t> ends) {
  std::sort(ends.begin(), ends.end());
  for (Region& region : regions_) {
    const std::vector<std::uint32_t>& blocks = region.look.blocks;
    const auto first = std::lower_bound(ends.begin(), ends.end(), blocks.front());
    const auto last = std::upper_bound(first, ends.end(), blocks.back());
    const bool seen = std::any_of(
        first, last, [&](std::uint32_t index) { return std::binary_search(blocks.begin(), blocks.end(), index); });
    region.seen += seen ? 1 : 0;
  }
}

std::optional<Look> RedrawQueue::due_look() {
  auto due = regions_.end();
  for (auto region = regions_.begin(); region != regions_.end(); ++region) {
    if (region->seen < region->next_look) continue;
    if (due == regions_.end() || region->looks_left > due->looks_left) due = region;
  }
  if (due == regions_.end()) return std::nullopt;
  Look look = due->look;
  due->seen = 0;
  due->next_look = std::min(3 * due->next_look, kMostBetween);
  if (--due->looks_left == 0) {
    look.is_last = true;
    forget(due);
  }
  return look;
}

}  // namespace deltamap::mapping::votes
