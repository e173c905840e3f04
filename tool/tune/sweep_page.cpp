// SPDX-License-Identifier: Apache-2.0
#include "tool/tune/sweep_page.hpp"

#include <charconv>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <utility>

#include "core/statistics/summary.hpp"
#include "reports/chart.hpp"
#include "reports/page_parts.hpp"
#include "reports/svg_chart.hpp"

namespace deltamap::tool::tune {
namespace {

using reports::Chart;
using reports::Series;

std::optional<double> number_in_value(const std::string& value) {
  double number = 0.0;
  const char* const end = value.data() + value.size();
  const auto [rest, error] = std::from_chars(value.data(), end, number);
  return error == std::errc{} && rest == end ? std::optional{number} : std::nullopt;
}

/// The points of a key's values: means over the settings that share a value. Empty where its values are no numbers.
std::vector<std::pair<double, double>> points_of(const TuningResult& result, const std::string& key,
                                                 const std::vector<double>& of_variants) {
  std::map<double, std::vector<double>> by_value;
  for (std::size_t i = 0; i < result.variants.size(); ++i) {
    for (const auto& [own, value] : result.variants[i].values) {
      const auto number = number_in_value(value);
      if (own == key && number && !std::isnan(of_variants[i])) by_value[*number].push_back(of_variants[i]);
    }
  }
  std::vector<std::pair<double, double>> points;
  for (const auto& [value, means] : by_value) points.emplace_back(value, mean_of(means));
  return points;
}

Chart chart_of(const TuningResult& result, const Ranking& ranking, const std::string& key) {
  const std::string measure{result.measure.name};
  Chart chart{measure + " over " + key, key, measure};
  std::vector<double> means;
  for (const Ranked& ranked : ranking.variants) means.push_back(ranked.mean);
  chart.series.push_back({"all recordings", points_of(result, key, means)});
  for (std::size_t drive = 0; result.drives.size() > 1 && drive < result.drives.size(); ++drive) {
    std::vector<double> of_drive;
    for (const Ranked& ranked : ranking.variants) of_drive.push_back(ranked.of_drives[drive]);
    chart.series.push_back({result.drives[drive]->files().name, points_of(result, key, of_drive)});
  }
  return chart;
}

std::string paragraphs(const std::vector<std::string>& words) {
  std::string html;
  for (const std::string& line : words) html += "<p>" + reports::escaped(line) + ".</p>\n";
  return html;
}

std::string recordings_text(const TuningResult& result) {
  std::string text;
  for (const auto& drive : result.drives) {
    text +=
        (text.empty() ? "Recordings: " : ", ") + drive->files().name + " on " + drive->files().map.filename().string();
  }
  return text + "; seeds " + std::to_string(result.seeds.front()) + " to " + std::to_string(result.seeds.back()) + ".";
}

/// `style_of`: of each row, null: none.
std::string grid_html(const std::string& name, const TextGrid& grid,
                      const std::function<const char*(std::size_t)>& style_of) {
  std::string rows;
  for (std::size_t i = 0; i < grid.rows.size(); ++i) {
    rows += "<tr>";
    for (const std::string& text : grid.rows[i]) rows += reports::cell(text, "td", style_of(i));
    rows += "</tr>\n";
  }
  return "<h2>" + reports::escaped(name) + "</h2>\n" + reports::table_of(name, grid.columns, rows);
}

}  // namespace

std::string sweep_page(const TuningResult& result, const Ranking& ranking) {
  std::string html = reports::page_begin("sweep");
  html += paragraphs(sweep_words(result, ranking));
  html += "<p class=\"from\">" + reports::escaped(recordings_text(result)) + " " +
          reports::escaped(reports::provenance_text(result.variants[ranking.best].settings.front())) +
          " Settings are those of the best on the first recording.</p>\n";
  html += grid_html("Settings", sweep_table(result, ranking), [&](std::size_t row) {
    if (row == ranking.best) return "met";
    return ranking.variants[row].is_worse ? "missed" : static_cast<const char*>(nullptr);
  });
  html += "<h2>Charts</h2>\n<div class=\"charts\">\n";
  for (const auto& [key, value] : result.variants.front().values) {
    const Chart chart = chart_of(result, ranking, key);
    if (chart.series.front().points.size() > 1) html += reports::figure_of(chart);
  }
  return html + "</div>\n" + reports::page_end();
}

std::string optimize_page(const TuningResult& pairs, const std::vector<std::string>& words) {
  std::string html = reports::page_begin("sweep --optimize");
  html += paragraphs(words);
  html += "<p class=\"from\">" + reports::escaped(recordings_text(pairs)) + " " +
          reports::escaped(reports::provenance_text(pairs.variants.back().settings.front())) +
          " Settings are those of the winner on the first recording.</p>\n";
  if (pairs.variants.size() > 1) {
    html += grid_html("On what the search did not see", compare_table(pairs, 0, 1),
                      [](std::size_t) { return static_cast<const char*>(nullptr); });
  }
  return html + reports::page_end();
}

}  // namespace deltamap::tool::tune
