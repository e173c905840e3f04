// SPDX-License-Identifier: Apache-2.0
#include "experiments/report/result_files.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <system_error>

#include "daemon/settings/provenance.hpp"

namespace deltamap::experiments {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Under another name first: whoever interrupts leaves the old file or none.
void write_whole(const fs::path& file, const std::string& content) {
  const fs::path part = file.string() + ".part";
  std::error_code error;
  {
    std::ofstream out(part, std::ios::binary | std::ios::trunc);
    out << content;
    if (!out.flush()) {
      out.close();
      fs::remove(part, error);
      throw std::runtime_error(file.string() + ": cannot be written");
    }
  }
  fs::rename(part, file, error);
  if (error) throw std::runtime_error(file.string() + ": cannot be written: " + error.message());
}

Json number_of(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

std::string cell_of(const std::string& text) {
  return text.find_first_of(",\"\n") == std::string::npos ? text : '"' + text + '"';
}

double number_or_nothing(const Outcome& outcome, const std::string& name) {
  for (const auto& [own, value] : outcome.numbers) {
    if (own == name) return value;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

/// Of all runs, each once, in the order in which they first come: not every run need have measured the same.
std::vector<std::string> numbers_in(const std::vector<Outcome>& outcomes) {
  std::vector<std::string> names;
  for (const Outcome& outcome : outcomes) {
    for (const auto& [name, value] : outcome.numbers) {
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
  }
  return names;
}

}  // namespace

void expect_writable(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  const fs::path probe = folder / ".experiment.part";
  const bool writable = !error && std::ofstream(probe).put('\n').flush().good();
  fs::remove(probe, error);
  if (!writable) throw std::runtime_error(folder.string() + ": cannot be written to");
}

std::string runs_csv(const Results& results) {
  const std::vector<std::string> numbers = numbers_in(results.outcomes);
  std::string csv = "run";
  if (!results.outcomes.empty()) {
    for (const auto& [name, value] : results.outcomes.front().labels) csv += "," + cell_of(name);
  }
  for (const std::string& name : numbers) csv += "," + cell_of(name);
  csv += '\n';
  for (std::size_t i = 0; i < results.runs.size(); ++i) {
    csv += cell_of(results.runs[i].name);
    for (const auto& [name, value] : results.outcomes[i].labels) csv += "," + cell_of(value);
    for (const std::string& name : numbers) csv += "," + text_of(number_or_nothing(results.outcomes[i], name));
    csv += '\n';
  }
  return csv;
}

std::string scans_csv(const ScanTable& scans) {
  std::string csv;
  for (std::size_t i = 0; i < scans.columns().size(); ++i) csv += (i == 0 ? "" : ",") + scans.columns()[i];
  csv += '\n';
  for (std::size_t row = 0; row < scans.rows(); ++row) {
    for (std::size_t i = 0; i < scans.columns().size(); ++i) csv += (i == 0 ? "" : ",") + text_of(scans.at(row, i));
    csv += '\n';
  }
  return csv;
}

std::string_view verdict_on(const Figure& figure) {
  if (!figure.target) return "";
  if (std::isnan(figure.value)) return "nothing measured";
  return figure.target->is_met_by(figure.value) ? "met" : "missed";
}

std::string summary_json(const Results& results) {
  Json summary{{"experiment", results.name}};
  daemon::add_provenance(summary, results.settings);
  summary["seed"] = results.seed;
  summary["quick"] = results.quick;
  summary["runs"] = results.runs.size();
  summary["figures"] = Json::array();
  bool all_met = true;
  for (const Figure& figure : results.report.figures) {
    Json json{{"name", figure.name}, {"value", number_of(figure.value)}, {"unit", figure.unit}};
    if (figure.target) {
      const bool met = figure.target->is_met_by(figure.value);
      all_met = all_met && met;
      json["target"] = Json::object();
      if (figure.target->least) json["target"]["least"] = *figure.target->least;
      if (figure.target->most) json["target"]["most"] = *figure.target->most;
      json["met"] = met;
    }
    if (figure.certainty) json["runs"] = figure.certainty->runs;
    if (figure.certainty && figure.certainty->has_interval()) {
      json["interval_95"] = {figure.certainty->low, figure.certainty->high};
    }
    if (!figure.peers.empty()) json["peers"] = figure.peers;
    summary["figures"].push_back(std::move(json));
  }
  summary["tables"] = Json::array();
  for (const TextTable& table : results.report.tables) {
    summary["tables"].push_back({{"title", table.title}, {"columns", table.columns}, {"rows", table.rows}});
  }
  summary["met"] = all_met;
  return summary.dump(2) + '\n';
}

void write_results(const Results& results, const fs::path& folder, bool with_scans) {
  write_whole(folder / (results.name + ".csv"), runs_csv(results));
  write_whole(folder / "summary.json", summary_json(results));
  write_whole(folder / "index.html", page_html(results));
  if (!with_scans) return;
  expect_writable(folder / "scans");
  for (std::size_t i = 0; i < results.runs.size(); ++i) {
    write_whole(folder / "scans" / (results.runs[i].name + ".csv"), scans_csv(results.outcomes[i].scans));
  }
}

}  // namespace deltamap::experiments
