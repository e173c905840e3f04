// SPDX-License-Identifier: Apache-2.0
#include "tool/tune/optimize.hpp"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <optional>

#include "core/files/replace_file.hpp"
#include "tool/tune/sweep_page.hpp"

namespace deltamap::tool::tune {
namespace {

constexpr std::uint64_t kFirstUnseenSeed = 1001;  // a search sees seeds from 1 on, and never so many
constexpr std::size_t kMostBlocks = 64;

/// The settings of each candidate that was drawn; nothing where they cannot be together.
class CandidateSettings {
 public:
  CandidateSettings(const SweepOptions& options, const std::vector<Parameter>& parameters, const Drives& drives,
                    const Variant& base)
      : options_{options}, parameters_{parameters}, drives_{drives}, variants_{base}, is_sound_{true} {}

  void take(const std::vector<Candidate>& drawn) {
    for (std::size_t i = variants_.size(); i < drawn.size(); ++i) {
      const auto variant = read(*drawn[i]);
      is_sound_.push_back(variant.has_value());
      variants_.push_back(variant.value_or(variants_.front()));
    }
  }
  [[nodiscard]] const std::vector<Variant>& variants() const { return variants_; }
  [[nodiscard]] bool is_sound(std::size_t candidate) const { return is_sound_[candidate]; }

 private:
  [[nodiscard]] std::optional<Variant> read(const std::vector<double>& point) const {
    std::vector<std::pair<std::string, std::string>> values;
    std::string name;
    for (std::size_t p = 0; p < parameters_.size(); ++p) {
      values.emplace_back(parameters_[p].key, parameters_[p].at(point[p]));
      name += (name.empty() ? "" : ", ") + values.back().first + "=" + values.back().second;
    }
    try {
      return variant_of(name, options_.common.config, values, drives_);
    } catch (const daemon::SettingsError&) {
      return std::nullopt;
    }
  }

  const SweepOptions& options_;
  const std::vector<Parameter>& parameters_;
  const Drives& drives_;
  std::vector<Variant> variants_;
  std::vector<bool> is_sound_;
};

/// Runs trials: a block is a recording and a seed, recordings in turn.
std::vector<double> costs_of_trials(const std::vector<Trial>& trials, const CandidateSettings& candidates,
                                    std::size_t searched_drives, const Measure& measure,
                                    const std::function<std::vector<MeasuredRun>(const std::vector<WantedRun>&)>& run) {
  std::vector<WantedRun> wanted;
  for (const Trial& trial : trials) {
    if (!candidates.is_sound(trial.candidate)) continue;
    wanted.push_back({trial.candidate, trial.block % searched_drives, 1 + trial.block / searched_drives});
  }
  const std::vector<MeasuredRun> runs = run(wanted);
  std::vector<double> costs;
  std::size_t next = 0;
  for (const Trial& trial : trials) {
    const bool is_sound = candidates.is_sound(trial.candidate);
    costs.push_back(is_sound ? measure.cost(number_of(runs[next++].numbers, measure.name))
                             : std::numeric_limits<double>::quiet_NaN());
  }
  return costs;
}

std::string found_words(const Searched& searched, const Variant& winner, std::size_t parameters) {
  return "searched " + std::to_string(parameters) + (parameters == 1 ? " key" : " keys") + " with " +
         std::to_string(searched.runs) + " runs of " + std::to_string(searched.drawn.size()) +
         " settings; first comes " + winner.name;
}

/// The winner against the settings as given.
std::string confirmation_words(const TuningResult& pairs) {
  const MeasuredValues values = pairs.values(pairs.measure.name);
  const PairedDifference difference = difference_of(values[0], values[1]);
  const std::string seen = " on what the search did not see: " + text_of(difference, pairs.measure) + " in " +
                           std::string{pairs.measure.name} + " (" + scope_of(difference) + ")";
  if (!difference.is_shown()) return "nothing: no difference that these recordings can show" + seen;
  return (pairs.measure.cost(difference.mean) < 0.0 ? "confirmed: better than the settings as given"
                                                    : "nothing: worse than the settings as given") +
         seen;
}

void tell_confirmation(const TuningResult& pairs, const std::vector<std::string>& words, const SweepOptions& options) {
  const std::string json = optimize_json(pairs, words);
  replace_file(options.out / "sweep.json", json);
  replace_file(options.out / "index.html", optimize_page(pairs, words));
  if (options.common.as_json) {
    std::cout << json;
    return;
  }
  if (pairs.variants.size() > 1) std::cout << padded(compare_table(pairs, 0, 1));
  for (const std::string& line : words) std::cout << line << '\n';
}

}  // namespace

BudgetShares shares_of(std::size_t budget, std::size_t drives_to_confirm) {
  BudgetShares shares;
  shares.seeds_to_confirm = std::max<std::size_t>(2, budget / 4 / (2 * drives_to_confirm));
  const std::size_t confirmation = 2 * drives_to_confirm * shares.seeds_to_confirm;
  if (budget < confirmation + kLeastBudget) {
    throw daemon::SettingsError("--optimize: " + std::to_string(budget) +
                                " runs are too few: " + std::to_string(confirmation) + " confirm, and " +
                                std::to_string(kLeastBudget) + " at least are searched with");
  }
  shares.search = budget - confirmation;
  return shares;
}

void optimize(const SweepOptions& options, const std::vector<Parameter>& parameters, Drives& drives,
              const Variant& base, const Measure& measure) {
  if (options.held_out >= drives.size()) throw daemon::SettingsError("--hold-out: no recording is left to search with");
  const std::size_t searched_drives = drives.size() - options.held_out;
  const std::size_t first_confirmed = options.held_out > 0 ? searched_drives : 0;
  const BudgetShares shares = shares_of(options.budget, drives.size() - first_confirmed);
  const auto is_interrupted = watch_for_interrupt();
  warn_of(drives, base);
  RunBook book{options.out, header_of(drives, base), options.anew};
  CandidateSettings candidates{options, parameters, drives, base};
  const auto costs_of = [&](const std::vector<Candidate>& drawn, const std::vector<Trial>& trials) {
    candidates.take(drawn);
    return costs_of_trials(trials, candidates, searched_drives, measure, [&](const std::vector<WantedRun>& wanted) {
      return kept_results(wanted, candidates.variants(), drives, book, options, is_interrupted);
    });
  };
  const HalvingParams params{parameters.size(), shares.search, kMostBlocks, options.search_seed};
  const Searched searched = searched_by_halving(params, costs_of);
  const Variant& winner = candidates.variants()[searched.winner];
  std::vector<std::string> words{found_words(searched, winner, parameters.size())};
  std::vector<Variant> compared{base};
  if (searched.winner != 0) compared.push_back({"found", winner.values, winner.settings});
  const auto seeds = seeds_from(kFirstUnseenSeed, static_cast<int>(shares.seeds_to_confirm));
  std::vector<WantedRun> wanted = every_run(compared.size(), drives.size(), seeds);
  std::erase_if(wanted, [&](const WantedRun& run) { return run.drive < first_confirmed; });
  auto runs = kept_results(wanted, compared, drives, book, options, is_interrupted);
  warn_of_foreign_maps(wanted, runs, drives);
  const TuningResult pairs{drives, std::move(compared), seeds, wanted, std::move(runs), measure};
  words.push_back(searched.winner == 0 ? "nothing better than the settings as given was found"
                                       : confirmation_words(pairs));
  tell_confirmation(pairs, words, options);
}

}  // namespace deltamap::tool::tune
