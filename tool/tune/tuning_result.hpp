// SPDX-License-Identifier: Apache-2.0
// What came out of runs of several settings, as text and as JSON.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tool/tune/ranking.hpp"
#include "tool/tune/tuning_runs.hpp"

namespace deltamap::tool::tune {

/// All runs of some variants on all drives with all seeds.
struct TuningResult {
  const Drives& drives;
  std::vector<Variant> variants;
  std::vector<std::uint64_t> seeds;
  std::vector<WantedRun> wanted;
  std::vector<MeasuredRun> runs;  ///< of those wanted
  const Measure& measure;         ///< that decides

  [[nodiscard]] MeasuredValues values(std::string_view of) const {
    return values_of(wanted, runs, of, variants.size(), drives.size(), seeds);
  }
  [[nodiscard]] Ranking ranking() const { return ranking_of(values(measure.name), measure); }
};

struct TextGrid {
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;
};
/// Columns padded to their widest cell; the first to the left, the others to the right.
[[nodiscard]] std::string padded(const TextGrid& grid);

/// A row a variant: mean, each drive, difference from the best, cost, and what it is.
[[nodiscard]] TextGrid sweep_table(const TuningResult& result, const Ranking& ranking);
/// In words: the best, the smallest that is not worse, or that these recordings tell no difference.
[[nodiscard]] std::vector<std::string> sweep_words(const TuningResult& result, const Ranking& ranking);
[[nodiscard]] std::string sweep_json(const TuningResult& result, const Ranking& ranking);

/// Two variants: a row a measure. Words on the deciding one behind it.
[[nodiscard]] TextGrid compare_table(const TuningResult& result, std::size_t first, std::size_t second);
[[nodiscard]] std::string compare_words(const TuningResult& result, std::size_t first, std::size_t second);
[[nodiscard]] std::string compare_json(const TuningResult& result);
/// The winner of a search against the settings as given, which come first; or these alone.
[[nodiscard]] std::string optimize_json(const TuningResult& pairs, const std::vector<std::string>& words);

}  // namespace deltamap::tool::tune
