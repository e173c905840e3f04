// SPDX-License-Identifier: Apache-2.0
// The page of an experiment's results: everything in one file.
#include <algorithm>
#include <cmath>
#include <span>
#include <string_view>
#include <vector>

#include "daemon/dashboard/page_files.hpp"
#include "daemon/telemetry/version.hpp"
#include "experiments/report/report_files.hpp"
#include "experiments/report/result_files.hpp"
#include "experiments/report/svg_chart.hpp"

namespace deltamap::experiments {
namespace {

std::string cell(const std::string& text, const char* kind = "td", const char* style = nullptr) {
  const std::string open = style == nullptr ? std::string{kind} : std::string{kind} + " class=\"" + style + "\"";
  return "<" + open + ">" + escaped(text) + "</" + kind + ">";
}

/// A table that scrolls by itself where the screen is too narrow; `rows` are HTML.
std::string table_of(const std::string& name, const std::vector<std::string>& columns, const std::string& rows) {
  std::string html =
      "<div class=\"wide\" tabindex=\"0\" role=\"region\" aria-label=\"" + escaped(name) + "\"><table><thead><tr>";
  for (const std::string& column : columns) html += cell(column, "th");
  return html + "</tr></thead>\n<tbody>" + rows + "</tbody></table></div>\n";
}

std::string text_of_target(const Target& target) {
  std::string text;
  if (target.least) text += "≥ " + short_text(*target.least);
  if (target.least && target.most) text += ", ";
  if (target.most) text += "≤ " + short_text(*target.most);
  return text;
}

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
    const char* met = !figure.target ? "" : figure.target->is_met_by(figure.value) ? "met" : "missed";
    rows += "<tr>" + cell(figure.name) + cell(met, "td", figure.target ? met : nullptr) +
            cell(short_text(figure.value) + unit, "td", "number");
    if (has_runs) rows += certainty_cells(figure);
    rows += figure.target ? cell(text_of_target(*figure.target), "td", "number") : cell("");
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

std::string file_of(std::span<const daemon::dashboard::PageFile> files, std::string_view name) {
  const auto file = std::find_if(files.begin(), files.end(), [&](const auto& one) { return one.name == name; });
  return std::string{file == files.end() ? std::string_view{} : file->content};
}

std::string head_html(const std::string& title) {
  return "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">"
         "<meta name=\"color-scheme\" content=\"light dark\"><link rel=\"icon\" href=\"data:,\">\n<title>" +
         escaped(title) + "</title>\n<style>\n" + file_of(daemon::dashboard::page_files(), "theme.css") +
         file_of(page_files(), "report.css") + "</style>\n<script>\n" + file_of(page_files(), "report.js") +
         "</script></head>\n";
}

/// "deltamap 0.1.0, commit fc42533; settings as delivered, but seed: 2"
std::string provenance_text(const daemon::Settings& settings) {
  std::string text = "deltamap " + std::string(daemon::version()) + ", commit " + std::string(daemon::commit()) +
                     "; settings as delivered";
  const char* before = ", but ";
  for (const auto& [key, value] : daemon::changed_settings(settings)) {
    text += before + key + ": " + value;
    before = ", ";
  }
  return text + ".";
}

}  // namespace

std::string page_html(const Results& results) {
  const Report& report = results.report;
  std::string html = head_html(results.name);
  html += "<body>\n<header><h1>" + escaped(results.name) +
          "</h1><button id=\"theme\" type=\"button\" aria-label=\"Dark or light\">◐</button></header>\n<main>\n";
  html += "<p>" + escaped(results.what) + ". " + std::to_string(results.runs.size()) +
          (results.runs.size() == 1 ? " run from seed " : " runs from seed ") + std::to_string(results.seed) +
          (results.quick ? ", quick" : "") + ".</p>\n";
  html += "<p class=\"from\">" + escaped(provenance_text(results.settings)) + "</p>\n";
  html += "<h2>Figures</h2>\n" + figures_html(report);
  if (!report.charts.empty()) html += "<h2>Charts</h2>\n<div class=\"charts\">\n";
  for (const Chart& chart : report.charts) html += figure_of(chart);
  if (!report.charts.empty()) html += "</div>\n";
  for (const TextTable& table : report.tables) html += table_html(table);
  if (!report.pictures.empty()) html += "<h2>Pictures</h2>\n<div class=\"charts\">\n";
  for (const Picture& picture : report.pictures) {
    html += "<figure class=\"picture\"><figcaption>" + escaped(picture.title) + "</figcaption>\n" + named(picture) +
            "</figure>\n";
  }
  if (!report.pictures.empty()) html += "</div>\n";
  return html + "</main></body></html>\n";
}

}  // namespace deltamap::experiments
