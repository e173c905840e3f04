// SPDX-License-Identifier: Apache-2.0
#include "tool/tune/tuning_result.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "daemon/telemetry/version.hpp"

namespace deltamap::tool::tune {
namespace {

using ResultJson = nlohmann::ordered_json;

ResultJson number_or_null(double value) { return std::isfinite(value) ? ResultJson(value) : ResultJson(nullptr); }

/// Code points: that is how wide a terminal shows what stands here.
std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

std::string what_it_is(std::size_t variant, const Ranking& ranking) {
  if (variant == ranking.best) return ranking.first_not_worse == variant ? "best, smallest not worse" : "best";
  if (variant == ranking.first_not_worse) return "smallest not worse";
  return ranking.variants[variant].is_worse ? "worse" : "";
}

ResultJson json_of(const PairedDifference& difference) {
  ResultJson json{{"mean", number_or_null(difference.mean)}, {"pairs", difference.pairs}};
  if (difference.has_interval()) {
    json["interval"] = {difference.low, difference.high};
    json["of"] = difference.of == PairedDifference::Of::kSeeds ? "seeds" : "recordings";
    json["shown"] = difference.is_shown();
  }
  return json;
}

ResultJson json_of_runs(const TuningResult& result) {
  ResultJson runs = ResultJson::array();
  for (std::size_t i = 0; i < result.wanted.size(); ++i) {
    const WantedRun& one = result.wanted[i];
    ResultJson run{{"recording", result.drives[one.drive]->files().name},
                   {"setting", result.variants[one.variant].name},
                   {"seed", one.seed},
                   {"trajectory", result.runs[i].trajectory},
                   {"map", result.runs[i].map}};
    for (const auto& [name, value] : result.runs[i].numbers) run[name] = number_or_null(value);
    runs.push_back(std::move(run));
  }
  return runs;
}

/// Of each variant the mean of every measure.
std::vector<ResultJson> json_of_means(const TuningResult& result) {
  std::vector<ResultJson> means(result.variants.size(), ResultJson::object());
  for (const Measure& measure : measures()) {
    const MeasuredValues values = result.values(measure.name);
    for (std::size_t variant = 0; variant < means.size(); ++variant) {
      const double mean = mean_over_drives(values[variant]);
      if (!std::isnan(mean)) means[variant][std::string{measure.name}] = mean;
    }
  }
  return means;
}

ResultJson head_of(const TuningResult& result) {
  ResultJson json{{"version", daemon::version()}, {"commit", daemon::commit()}, {"measure", result.measure.name}};
  json["recordings"] = ResultJson::array();
  for (const auto& drive : result.drives) json["recordings"].push_back(drive->files().name);
  json["seeds"] = result.seeds;
  return json;
}

}  // namespace

std::string padded(const TextGrid& grid) {
  std::vector<std::size_t> widths;
  for (const std::string& column : grid.columns) widths.push_back(width_of(column));
  for (const auto& row : grid.rows) {
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], width_of(row[i]));
  }
  std::string text;
  const auto add = [&](const std::vector<std::string>& row) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string gap(widths[i] - width_of(row[i]), ' ');
      line += (i == 0 ? "" : "  ") + (i == 0 ? row[i] + gap : gap + row[i]);
    }
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  };
  add(grid.columns);
  for (const auto& row : grid.rows) add(row);
  return text;
}

TextGrid sweep_table(const TuningResult& result, const Ranking& ranking) {
  TextGrid grid{{"setting", std::string{result.measure.name}}, {}};
  const bool has_several = result.drives.size() > 1;
  for (const auto& drive : result.drives) {
    if (has_several) grid.columns.push_back(drive->files().name);
  }
  for (const char* column : {"from the best", "cpu_ms", ""}) grid.columns.emplace_back(column);
  const MeasuredValues cpu_ms = result.values("cpu_ms");
  for (std::size_t i = 0; i < ranking.variants.size(); ++i) {
    const Ranked& ranked = ranking.variants[i];
    std::vector<std::string> row{result.variants[i].name, digits_of(ranked.mean)};
    for (const double mean : ranked.of_drives) {
      if (has_several) row.push_back(digits_of(mean));
    }
    row.push_back(i == ranking.best ? "" : text_of(ranked.from_best, result.measure));
    row.push_back(digits_of(mean_over_drives(cpu_ms[i])));
    row.push_back(what_it_is(i, ranking));
    grid.rows.push_back(std::move(row));
  }
  return grid;
}

std::vector<std::string> sweep_words(const TuningResult& result, const Ranking& ranking) {
  const std::string& best = result.variants[ranking.best].name;
  const std::string value = digits_of(ranking.variants[ranking.best].mean);
  if (result.variants.size() == 1) return {best + ": " + std::string{result.measure.name} + " " + value};
  const std::size_t other = ranking.best == 0 ? 1 : 0;
  const std::string scope = " (" + scope_of(ranking.variants[other].from_best) + ")";
  std::vector<std::string> words;
  if (!ranking.has_intervals) {
    words.push_back("best by " + std::string{result.measure.name} + ": " + best +
                    "; too few runs to tell whether that means anything: give more seeds" + scope);
  } else if (!ranking.tells) {
    words.push_back("no difference that these recordings can show: " + best + " comes out first with " + value +
                    ", and no setting is shown to be worse" + scope);
  } else {
    words.push_back("best by " + std::string{result.measure.name} + ": " + best + " with " + value + scope);
    const std::size_t smallest = ranking.first_not_worse;
    if (smallest != ranking.best)
      words.push_back("smallest that is not shown to be worse: " + result.variants[smallest].name + " with " +
                      digits_of(ranking.variants[smallest].mean));
  }
  return words;
}

std::string sweep_json(const TuningResult& result, const Ranking& ranking) {
  const std::vector<ResultJson> means = json_of_means(result);
  ResultJson json = head_of(result);
  json["settings"] = ResultJson::array();
  for (std::size_t i = 0; i < result.variants.size(); ++i) {
    const Ranked& ranked = ranking.variants[i];
    ResultJson one{{"name", result.variants[i].name}, {"values", ResultJson::object()}};
    for (const auto& [key, value] : result.variants[i].values) {
      one["values"][key] = ResultJson::accept(value) ? ResultJson::parse(value) : ResultJson(value);
    }
    one["mean"] = number_or_null(ranked.mean);
    for (std::size_t drive = 0; drive < result.drives.size(); ++drive)
      one["recordings"][result.drives[drive]->files().name] = number_or_null(ranked.of_drives[drive]);
    if (i != ranking.best) one["from_best"] = json_of(ranked.from_best);
    one["worse"] = ranked.is_worse;
    one["measures"] = means[i];
    json["settings"].push_back(std::move(one));
  }
  json["best"] = result.variants[ranking.best].name;
  json["smallest_not_worse"] = result.variants[ranking.first_not_worse].name;
  json["difference_shown"] = ranking.tells;
  json["words"] = sweep_words(result, ranking);
  json["runs"] = json_of_runs(result);
  return json.dump(2) + "\n";
}

TextGrid compare_table(const TuningResult& result, std::size_t first, std::size_t second) {
  TextGrid grid{{"", result.variants[first].name, result.variants[second].name, "difference", ""}, {}};
  for (const Measure& measure : measures()) {
    const MeasuredValues values = result.values(measure.name);
    const double a = mean_over_drives(values[first]);
    const double b = mean_over_drives(values[second]);
    if (std::isnan(a) && std::isnan(b)) continue;
    const PairedDifference difference = difference_of(values[first], values[second]);
    grid.rows.push_back({std::string{measure.name}, digits_of(a), digits_of(b), text_of(difference, measure),
                         verdict_of(difference, measure, result.variants[first].name, result.variants[second].name)});
  }
  return grid;
}

std::string compare_words(const TuningResult& result, std::size_t first, std::size_t second) {
  const MeasuredValues values = result.values(result.measure.name);
  const PairedDifference difference = difference_of(values[first], values[second]);
  return std::string{result.measure.name} + ", " + result.variants[first].name + " against " +
         result.variants[second].name + ": " +
         verdict_of(difference, result.measure, result.variants[first].name, result.variants[second].name) + " (" +
         text_of(difference, result.measure) + "; " + scope_of(difference) + ")";
}

namespace {

ResultJson json_of_comparison(const TuningResult& result) {
  const std::vector<ResultJson> means = json_of_means(result);
  ResultJson json = head_of(result);
  json["settings"] = ResultJson::array();
  for (std::size_t i = 0; i < result.variants.size(); ++i)
    json["settings"].push_back({{"name", result.variants[i].name}, {"measures", means[i]}});
  json["differences"] = ResultJson::array();
  for (std::size_t second = 1; second < result.variants.size(); ++second) {
    for (const Measure& measure : measures()) {
      const MeasuredValues values = result.values(measure.name);
      const PairedDifference difference = difference_of(values[0], values[second]);
      if (std::isnan(difference.mean)) continue;
      ResultJson one = json_of(difference);
      one["measure"] = measure.name;
      one["first"] = result.variants[0].name;
      one["second"] = result.variants[second].name;
      one["words"] = verdict_of(difference, measure, result.variants[0].name, result.variants[second].name);
      json["differences"].push_back(std::move(one));
    }
    json["words"].push_back(compare_words(result, 0, second));
  }
  json["runs"] = json_of_runs(result);
  return json;
}

}  // namespace

std::string compare_json(const TuningResult& result) { return json_of_comparison(result).dump(2) + "\n"; }

std::string optimize_json(const TuningResult& pairs, const std::vector<std::string>& words) {
  ResultJson json = json_of_comparison(pairs);
  json["words"] = words;
  json["winner"] = ResultJson::object();
  for (const auto& [key, value] : pairs.variants.back().values)
    json["winner"][key] = ResultJson::accept(value) ? ResultJson::parse(value) : ResultJson(value);
  return json.dump(2) + "\n";
}

}  // namespace deltamap::tool::tune
