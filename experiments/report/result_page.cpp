// SPDX-License-Identifier: Apache-2.0
// The page of an experiment's results: everything in one file.
#include <cmath>

#include "daemon/telemetry/version.hpp"
#include "experiments/report/result_files.hpp"
#include "experiments/report/svg_chart.hpp"

namespace deltamap::experiments {
namespace {

constexpr const char* kHead = R"html(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">
<style>
body { font: 15px/1.45 system-ui, sans-serif; max-width: 62rem; margin: 2rem auto; padding: 0 1rem; color: #222; }
table { border-collapse: collapse; margin: .5rem 0 1.5rem; font-variant-numeric: tabular-nums; }
th, td { padding: .2rem .7rem; border-bottom: 1px solid #ddd; text-align: left; }
.met { color: #1d7a3a; } .missed { color: #b3261e; font-weight: 600; }
svg { width: 100%; height: auto; } svg text { font: 12px system-ui, sans-serif; fill: #333; }
</style>
)html";

std::string cell(const std::string& text, const char* kind = "td", const char* style = nullptr) {
  const std::string open = style == nullptr ? std::string{kind} : std::string{kind} + " class=\"" + style + "\"";
  return "<" + open + ">" + escaped(text) + "</" + kind + ">";
}

std::string text_of_target(const Target& target) {
  std::string text;
  if (target.least) text += "≥ " + text_of(*target.least);
  if (target.least && target.most) text += ", ";
  if (target.most) text += "≤ " + text_of(*target.most);
  return text;
}

std::string figures_html(const Report& report) {
  std::string html = "<table><tr>";
  for (const char* name : {"figure", "measured", "target", "", "others"}) html += cell(name, "th");
  html += "</tr>\n";
  for (const Figure& figure : report.figures) {
    const std::string value = std::isnan(figure.value) ? "–" : text_of(figure.value);
    html += "<tr>" + cell(figure.name) + cell(value + (figure.unit.empty() ? "" : " " + figure.unit));
    if (figure.target) {
      const bool met = figure.target->is_met_by(figure.value);
      html += cell(text_of_target(*figure.target)) + cell(met ? "met" : "missed", "td", met ? "met" : "missed");
    } else {
      html += cell("") + cell("");
    }
    html += cell(figure.peers) + "</tr>\n";
  }
  return html + "</table>\n";
}

std::string table_html(const TextTable& table) {
  std::string html = "<h2>" + escaped(table.title) + "</h2>\n<table><tr>";
  for (const std::string& column : table.columns) html += cell(column, "th");
  html += "</tr>\n";
  for (const auto& row : table.rows) {
    html += "<tr>";
    for (const std::string& text : row) html += cell(text);
    html += "</tr>\n";
  }
  return html + "</table>\n";
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
  std::string html = kHead;
  html += "<title>" + escaped(results.name) + "</title></head><body>\n<h1>" + escaped(results.name) + "</h1>\n";
  html += "<p>" + escaped(results.what) + ". " + std::to_string(results.runs.size()) + " runs from seed " +
          std::to_string(results.seed) + (results.quick ? ", quick" : "") + ".</p>\n";
  html += "<p>" + escaped(provenance_text(results.settings)) + "</p>\n";
  html += figures_html(results.report);
  for (const TextTable& table : results.report.tables) html += table_html(table);
  for (const Chart& chart : results.report.charts) html += "<h2>" + escaped(chart.title) + "</h2>\n" + svg_of(chart);
  for (const Picture& picture : results.report.pictures)
    html += "<h2>" + escaped(picture.title) + "</h2>\n" + picture.svg;
  return html + "</body></html>\n";
}

}  // namespace deltamap::experiments
