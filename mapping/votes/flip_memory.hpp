// SPDX-License-Identifier: Apache-2.0
// Remembers which blocks of the map are written back and forth: a door, a pane that only some beams see, a place where
// somebody keeps stopping. What toggles is no change of the map.
#pragma once

#include <cstddef>
#include <cstdint>
#include <unordered_map>

#include "mapping/votes/vote_layer.hpp"

namespace deltamap::mapping::votes {

struct FlipParams {
  double half_life_s = 900.0;        ///< of a flip's weight; > 0
  double toggles_from = 2.5;         ///< flips, the old ones worn, from which on a block toggles; > 0
  std::uint32_t most_blocks = 8192;  ///< remembered, some 40 bytes each; beyond, all that is worn is forgotten
};

class FlipMemory {
 public:
  FlipMemory() = default;
  explicit FlipMemory(const FlipParams& params) : params_{params} {}

  /// The block is about to be written as that question's "yes".
  void note(std::uint32_t block, Question question, std::uint32_t now_ms);
  /// By how many flips the block is past toggles_from; negative: it does not toggle.
  [[nodiscard]] double beyond(std::uint32_t block, std::uint32_t now_ms) const;

 private:
  struct Flips {
    float count = 0.0F;
    std::uint32_t last_ms = 0;
    Question last = Question::kAdded;
  };
  [[nodiscard]] double worn(const Flips& flips, std::uint32_t now_ms) const;

  FlipParams params_;
  std::unordered_map<std::uint32_t, Flips> blocks_;
};

}  // namespace deltamap::mapping::votes
