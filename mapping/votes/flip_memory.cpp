// SPDX-License-Identifier: Apache-2.0
#include "mapping/votes/flip_memory.hpp"

#include <cmath>

namespace deltamap::mapping::votes {
namespace {

constexpr double kFutile = 0.25;  // of a flip: the same again, for it has not become map

}  // namespace

double FlipMemory::worn(const Flips& flips, std::uint32_t now_ms) const {
  return static_cast<double>(flips.count) * std::exp2(-1e-3 * (now_ms - flips.last_ms) / params_.half_life_s);
}

void FlipMemory::note(std::uint32_t block, Question question, std::uint32_t now_ms) {
  if (blocks_.size() >= params_.most_blocks) {
    constexpr double kWorn = 0.25;
    std::erase_if(blocks_, [&](const auto& entry) { return worn(entry.second, now_ms) < kWorn; });
    if (blocks_.size() >= params_.most_blocks) blocks_.clear();
  }
  const auto [entry, is_new] = blocks_.try_emplace(block, Flips{0.0F, now_ms, question});
  Flips& flips = entry->second;
  if (is_new) return;
  const double weight = flips.last != question ? 1.0 : kFutile;
  flips = {static_cast<float>(worn(flips, now_ms) + weight), now_ms, question};
}

double FlipMemory::beyond(std::uint32_t block, std::uint32_t now_ms) const {
  const auto entry = blocks_.find(block);
  return (entry == blocks_.end() ? 0.0 : worn(entry->second, now_ms)) - params_.toggles_from;
}

}  // namespace deltamap::mapping::votes
