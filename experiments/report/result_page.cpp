// SPDX-License-Identifier: Apache-2.0
// The page of an experiment's results: everything in one file.
#include <algorithm>
#include <cmath>
#include <vector>

#include "experiments/report/result_files.hpp"
#include "reports/number_text.hpp"
#include "reports/page_parts.hpp"
#include "reports/svg_chart.hpp"

namespace deltamap::experiments {
namespace {

using reports::cell;
using reports::escaped;
using reports::short_text;
using reports::shortened;
using reports::table_of;

bool has_certainty(const Figure& figure) { return figure.certainty.has_value(); }

std::string certainty_cells(const Figure& figure) {
  if (!figure.certainty) return cell("") + cell("");
  const Certainty& certainty = *figure.certainty;
  const std::string interval =
      certainty.has_interval() ? short_text(certainty.low) + " … " + short_text(certainty.high) : "";
  return cell(interval, "td", "number") + cell(std::to_string(certainty.runs));
}

std::string figures_html(const Report& report) {
  const bool has_runs = std::any_of(report.figures.begin(), report.figures.end(), has_certainty);
  std::string rows;
  for (const Figure& figure : report.figures) {
    const std::string unit = std::isnan(figure.value) || figure.unit.empty() ? "" : " " + figure.unit;
    // Whether it is met stands in front: a narrow screen shows it without scrolling.
    const std::string verdict{verdict_on(figure)};
    rows += "<tr>" + cell(figure.name) + cell(verdict, "td", figure.target ? verdict.c_str() : nullptr) +
            cell(short_text(figure.value) + unit, "td", "number");
    if (has_runs) rows += certainty_cells(figure);
    rows += figure.target ? cell(text_of(*figure.target), "td", "number") : cell("");
    rows += cell(shortened(figure.peers), "td", figure.peers.empty() ? nullptr : "others") + "</tr>\n";
  }
  std::vector<std::string> columns{"figure", "met", "measured", "95 % interval", "runs", "target", "others"};
  if (!has_runs) columns.erase(columns.begin() + 3, columns.begin() + 5);
  return table_of("Figures", columns, rows);
}

std::string table_html(const TextTable& table) {
  std::string rows;
  for (const auto& row : table.rows) {
    rows += "<tr>";
    for (const std::string& text : row) rows += cell(shortened(text));
    rows += "</tr>\n";
  }
  return "<h2>" + escaped(table.title) + "</h2>\n" + table_of(table.title, table.columns, rows);
}

/// The picture with its title for those who hear the page.
std::string named(const Picture& picture) {
  std::string svg = picture.svg;
  const std::string begin = "<svg ";
  if (svg.starts_with(begin)) svg.insert(begin.size(), "role=\"img\" aria-label=\"" + escaped(picture.title) + "\" ");
  return svg;
}

}  // namespace

std::string text_of(const Target& target) {
  std::string text;
  if (target.least) text += "≥ " + short_text(*target.least);
  if (target.least && target.most) text += ", ";
  if (target.most) text += "≤ " + short_text(*target.most);
  return text;
}

std::string page_html(const Results& results) {
  const Report& report = results.report;
  std::string html = reports::page_begin(results.name);
  html += "<p>" + escaped(results.what) + ". " + std::to_string(results.runs.size()) +
          (results.runs.size() == 1 ? " run from seed " : " runs from seed ") + std::to_string(results.seed) +
          (results.quick ? ", quick" : "") + ".</p>\n";
  html += "<p class=\"from\">" + escaped(reports::provenance_text(results.settings)) + "</p>\n";
  html += "<h2>Figures</h2>\n" + figures_html(report);
  if (!report.charts.empty()) html += "<h2>Charts</h2>\n<div class=\"charts\">\n";
  for (const Chart& chart : report.charts) html += reports::figure_of(chart);
  if (!report.charts.empty()) html += "</div>\n";
  for (const TextTable& table : report.tables) html += table_html(table);
  if (!report.pictures.empty()) html += "<h2>Pictures</h2>\n<div class=\"charts\">\n";
  for (const Picture& picture : report.pictures) {
    html += "<figure class=\"picture\"><figcaption>" + escaped(picture.title) + "</figcaption>\n" + named(picture) +
            "</figure>\n";
  }
  if (!report.pictures.empty()) html += "</div>\n";
  return html + reports::page_end();
}

}  // namespace deltamap::experiments
