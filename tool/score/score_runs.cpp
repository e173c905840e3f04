// SPDX-License-Identifier: Apache-2.0
#include "tool/score/score_runs.hpp"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>

#include "core/statistics/summary.hpp"
#include "tool/score/run_score.hpp"
#include "tool/tune/tuning_result.hpp"

namespace deltamap::tool::tune {
namespace {

namespace fs = std::filesystem;
using ScoreJson = nlohmann::ordered_json;

/// A measure over the seeds of a recording; of a folder there is one value.
struct Scored {
  std::string name;
  std::vector<Numbers> runs;
};

std::vector<double> values_in(const Scored& scored, std::string_view measure) {
  std::vector<double> values;
  for (const Numbers& run : scored.runs) {
    const double value = number_of(run, measure);
    if (!std::isnan(value)) values.push_back(value);
  }
  return values;
}

/// "0.0544", or "0.0544 (0.0541 … 0.0549)" where the seeds differ.
std::string cell_of_score(const std::vector<double>& values) {
  if (values.empty()) return "–";
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  std::string text = digits_of(mean_of(values));
  if (*least != *most) text += " (" + digits_of(*least) + " … " + digits_of(*most) + ")";
  return text;
}

void print(const std::vector<Scored>& all) {
  TextGrid grid{{""}, {}};
  for (const Scored& one : all) grid.columns.push_back(one.name);
  for (const Measure& measure : measures()) {
    std::vector<std::string> row{std::string{measure.name}};
    bool is_known = false;
    for (const Scored& one : all) {
      const std::vector<double> values = values_in(one, measure.name);
      is_known = is_known || !values.empty();
      row.push_back(cell_of_score(values));
    }
    if (is_known) grid.rows.push_back(std::move(row));
  }
  std::cout << padded(grid);
}

void print_json(const std::vector<Scored>& all) {
  ScoreJson json = ScoreJson::array();
  for (const Scored& one : all) {
    ScoreJson scored{{"name", one.name}, {"runs", one.runs.size()}, {"measures", ScoreJson::object()}};
    for (const Measure& measure : measures()) {
      const std::vector<double> values = values_in(one, measure.name);
      if (values.empty()) continue;
      const auto [least, most] = std::minmax_element(values.begin(), values.end());
      scored["measures"][std::string{measure.name}] = {{"mean", mean_of(values)}, {"least", *least}, {"most", *most}};
    }
    json.push_back(std::move(scored));
  }
  std::cout << json.dump(2) << '\n';
}

std::vector<Scored> scored_folders(TuningOptions options) {
  const std::vector<std::string> folders = options.recordings;
  if (options.maps.empty()) options.maps = {"-"};
  std::vector<Scored> all;
  for (std::size_t i = 0; i < folders.size(); ++i) {
    const ScoredFolder scored = scored_folder(folders[i], map_of(options, i), true_way_of(options, i));
    for (const std::string& note : scored.notes) std::cerr << "deltamap: " << folders[i] << ": " << note << '\n';
    all.push_back({folders[i], {scored.numbers}});
  }
  return all;
}

std::vector<Scored> scored_recordings(const TuningOptions& options) {
  Drives drives = drives_of(options);
  const std::vector<Variant> as_given{variant_of("as given", options.config, {}, drives)};
  warn_of(drives, as_given.front());
  const auto wanted = every_run(1, drives.size(), seeds_from(1, options.seeds));
  const auto runs =
      results_of(wanted, as_given, drives, nullptr, {jobs_of(options), true, false, watch_for_interrupt()});
  warn_of_foreign_maps(wanted, runs, drives);
  std::vector<Scored> all;
  for (std::size_t drive = 0; drive < drives.size(); ++drive) {
    Scored scored{drives[drive]->files().name, {}};
    std::vector<std::vector<TunedDrive::StampedPose>> poses;
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      if (wanted[i].drive != drive) continue;
      scored.runs.push_back(runs[i].numbers);
      poses.push_back(runs[i].poses);
    }
    const double repeatability = repeatability_m(poses);
    if (!std::isnan(repeatability)) scored.runs.front().emplace_back("repeatability_m", repeatability);
    all.push_back(std::move(scored));
  }
  return all;
}

}  // namespace

void score_runs(TuningOptions options) {
  const auto is_folder = [](const std::string& name) { return fs::is_directory(name); };
  const auto folders = std::count_if(options.recordings.begin(), options.recordings.end(), is_folder);
  if (folders > 0 && folders < static_cast<std::ptrdiff_t>(options.recordings.size()))
    throw daemon::SettingsError("score: give folders of runs, or recordings: not both at once");
  const bool as_json = options.as_json;
  const std::vector<Scored> all = folders > 0 ? scored_folders(std::move(options)) : scored_recordings(options);
  as_json ? print_json(all) : print(all);
}

}  // namespace deltamap::tool::tune
