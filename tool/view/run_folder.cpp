// SPDX-License-Identifier: Apache-2.0
#include "tool/view/run_folder.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <fstream>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string_view>

#include "core/counted.hpp"
#include "daemon/settings/settings.hpp"
#include "daemon/telemetry/telemetry.hpp"

namespace deltamap::tool {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

[[noreturn]] void fail(const fs::path& file, int line, const std::string& why) {
  throw std::runtime_error(file.string() + ":" + std::to_string(line) + ": " + why);
}

template <typename Number>
Number number_in(std::string_view text) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size()) {
    throw std::invalid_argument("'" + std::string(text) + "' is no number");
  }
  return number;
}

/// "1764000000.250000000", without the digits that a double would lose.
Timestamp time_of_line(std::string_view text) {
  constexpr std::size_t kDigits = 9;
  const std::size_t point = text.find('.');
  if (point == std::string_view::npos || text.size() - point - 1 != kDigits) {
    throw std::invalid_argument("'" + std::string(text) + "' is no time");
  }
  const auto whole = number_in<std::int64_t>(text.substr(0, point));
  return timestamp_from_ns(whole * 1'000'000'000 + number_in<std::uint32_t>(text.substr(point + 1)));
}

template <typename Value, std::size_t size>
Value named(std::string_view text, const std::array<Value, size>& values) {
  for (const Value value : values) {
    if (daemon::name_of(value) == text) return value;
  }
  throw std::invalid_argument("'" + std::string(text) + "' is unknown");
}

constexpr std::array kStates{LocalizerState::kGlobal, LocalizerState::kTracking, LocalizerState::kLost};
constexpr std::array kVerdicts{PoseVerdict::kUndecided, PoseVerdict::kRight, PoseVerdict::kWrong};

using Assign = std::function<void(daemon::LocalizationRow&, std::string_view)>;

Assign number_column(double& (*field)(daemon::LocalizationRow&)) {
  return [field](daemon::LocalizationRow& row, std::string_view text) { field(row) = number_in<double>(text); };
}
Assign count_column(std::uint32_t daemon::LocalizationRow::*field) {
  return [field](daemon::LocalizationRow& row, std::string_view text) { row.*field = number_in<std::uint32_t>(text); };
}
/// All are 0 where the scan was not held against the map.
Assign beams_column(BeamCounts Belief::*beams, std::uint32_t BeamCounts::*field) {
  return [beams, field](daemon::LocalizationRow& row, std::string_view text) {
    const auto count = number_in<std::uint32_t>(text);
    (row.belief.*beams).*field = count;
    row.belief.is_checked = row.belief.is_checked || count > 0;
  };
}
Assign covariance_column(int i, int j) {
  return [i, j](daemon::LocalizationRow& row, std::string_view text) {
    row.covariance(i, j) = row.covariance(j, i) = number_in<double>(text);
  };
}

using Row = daemon::LocalizationRow;
using Columns = std::map<std::string, Assign, std::less<>>;

Columns columns_of_pose() {
  return {{"time", [](Row& row, std::string_view text) { row.time = time_of_line(text); }},
          {"number", count_column(&Row::number)},
          {"state", [](Row& row, std::string_view text) { row.state = named(text, kStates); }},
          {"x_m", number_column([](Row& row) -> double& { return row.map_from_robot.x; })},
          {"y_m", number_column([](Row& row) -> double& { return row.map_from_robot.y; })},
          {"heading_rad", number_column([](Row& row) -> double& { return row.map_from_robot.theta; })},
          {"w_avg", number_column([](Row& row) -> double& { return row.w_avg; })},
          {"w_fast", number_column([](Row& row) -> double& { return row.w_fast; })},
          {"w_slow", number_column([](Row& row) -> double& { return row.w_slow; })},
          {"r_d", number_column([](Row& row) -> double& { return row.r_d; })},
          {"n_eff", number_column([](Row& row) -> double& { return row.n_eff; })},
          {"particles", count_column(&Row::particles)},
          {"revision", count_column(&Row::revision)},
          {"speed_m_per_s", number_column([](Row& row) -> double& { return row.speed_m_per_s; })},
          {"turn_rate_rad_per_s", number_column([](Row& row) -> double& { return row.turn_rate_rad_per_s; })}};
}

Columns columns_of_belief() {
  return {{"pose_right", number_column([](Row& row) -> double& { return row.belief.pose_right; })},
          {"map_wrong", number_column([](Row& row) -> double& { return row.belief.map_wrong; })},
          {"verdict", [](Row& row, std::string_view text) { row.belief.verdict = named(text, kVerdicts); }},
          {"stable_expected", beams_column(&Belief::stable, &BeamCounts::expected)},
          {"stable_fit", beams_column(&Belief::stable, &BeamCounts::fit)},
          {"stable_short", beams_column(&Belief::stable, &BeamCounts::short_of)},
          {"stable_beyond", beams_column(&Belief::stable, &BeamCounts::beyond)},
          {"elsewhere_expected", beams_column(&Belief::elsewhere, &BeamCounts::expected)},
          {"elsewhere_fit", beams_column(&Belief::elsewhere, &BeamCounts::fit)},
          {"elsewhere_short", beams_column(&Belief::elsewhere, &BeamCounts::short_of)},
          {"elsewhere_beyond", beams_column(&Belief::elsewhere, &BeamCounts::beyond)},
          {"rival_share", number_column([](Row& row) -> double& { return row.belief.other_share; })},
          {"rival_x_m", number_column([](Row& row) -> double& { return row.belief.map_from_other.x; })},
          {"rival_y_m", number_column([](Row& row) -> double& { return row.belief.map_from_other.y; })},
          {"rival_heading_rad", number_column([](Row& row) -> double& { return row.belief.map_from_other.theta; })}};
}

Columns columns_of_covariance() {
  return {{"cov_xx", covariance_column(0, 0)}, {"cov_xy", covariance_column(0, 1)},
          {"cov_xh", covariance_column(0, 2)}, {"cov_yy", covariance_column(1, 1)},
          {"cov_yh", covariance_column(1, 2)}, {"cov_hh", covariance_column(2, 2)}};
}

/// By their names, so that an older run with fewer columns can be read.
const Columns& columns() {
  static const Columns known = [] {
    Columns all = columns_of_pose();
    all.merge(columns_of_belief());
    all.merge(columns_of_covariance());
    return all;
  }();
  return known;
}

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  for (std::size_t at = 0;;) {
    const std::size_t comma = line.find(',', at);
    words.push_back(line.substr(at, comma == std::string_view::npos ? comma : comma - at));
    if (comma == std::string_view::npos) return words;
    at = comma + 1;
  }
}

/// Each whole line with its number, from 1. True where the last one is cut: it has no line end.
bool each_line(const fs::path& file, const std::function<void(const std::string&, int)>& take) {
  std::ifstream in(file);
  if (!in) throw std::runtime_error(file.string() + ": cannot be read");
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    if (in.eof()) return !line.empty();
    take(line, number);
  }
  return false;
}

std::vector<const Assign*> columns_named(const fs::path& file, const std::string& header) {
  std::vector<const Assign*> order;
  std::size_t needed = 0;
  for (const std::string_view name : words_of(header)) {
    const auto found = columns().find(name);
    order.push_back(found == columns().end() ? nullptr : &found->second);
    for (const char* must : {"time", "state", "x_m", "y_m", "heading_rad"}) needed += name == must ? 1 : 0;
  }
  if (needed != 5) fail(file, 1, "is no log of a localizer: time, state, x_m, y_m and heading_rad are not all there");
  return order;
}

daemon::LocalizationRow row_in(const std::string& line, const std::vector<const Assign*>& order) {
  const auto words = words_of(line);
  if (words.size() != order.size()) {
    throw std::invalid_argument(std::to_string(words.size()) + " values in place of " + std::to_string(order.size()));
  }
  daemon::LocalizationRow row;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (order[i] != nullptr) (*order[i])(row, words[i]);
  }
  return row;
}

/// Older runs have scans whose stamps step back: shown in the order of their stamps, which is told.
void put_in_order(const fs::path& file, int back_steps, int first_back, RunFolder& run) {
  if (back_steps == 0) return;
  std::stable_sort(run.rows.begin(), run.rows.end(),
                   [](const Row& one, const Row& other) { return one.time < other.time; });
  run.notes.push_back(
      file.string() + ":" + std::to_string(first_back) + ": the time steps back" +
      (back_steps == 1 ? ""
                       : ", as in " + counted(static_cast<std::uint64_t>(back_steps - 1), "line more", "lines more")) +
      "; scans are shown in the order of their times");
}

void read_rows(const fs::path& file, RunFolder& run) {
  std::vector<const Assign*> order;
  int back_steps = 0;
  int first_back = 0;
  const bool is_cut = each_line(file, [&](const std::string& line, int number) {
    if (number == 1) {
      order = columns_named(file, line);
      return;
    }
    try {
      run.rows.push_back(row_in(line, order));
    } catch (const std::invalid_argument& error) {
      fail(file, number, error.what());
    }
    const std::size_t count = run.rows.size();
    const bool steps_back = count > 1 && run.rows[count - 1].time < run.rows[count - 2].time;
    if (steps_back && ++back_steps == 1) first_back = number;
  });
  put_in_order(file, back_steps, first_back, run);
  if (order.empty()) fail(file, 1, "has no line with the names of its columns");
  if (is_cut) run.notes.push_back(file.string() + ": its last line is cut");
  if (run.rows.empty()) throw std::runtime_error(file.string() + ": holds no scan");
}

daemon::ChangeNote change_in(const Json& json) {
  daemon::ChangeNote note;
  note.time = timestamp_from_ns(static_cast<std::int64_t>(json.at("time").get<double>() * 1e6) * 1000);
  json.at("phase").get_to(note.phase);
  json.at("scans").get_to(note.scans);
  if (!json.at("revision").is_null()) note.revision = json.at("revision").get<std::uint32_t>();
  json.at("added").get_to(note.added);
  json.at("freed").get_to(note.freed);
  note.forgotten = json.value("forgotten", 0U);
  const auto box = json.at("box_m").get<std::array<double, 4>>();
  note.box_low = {box[0], box[1]};
  note.box_high = {box[2], box[3]};
  json.at("acceptance").get_to(note.acceptance);
  note.reason = json.value("reason", "");
  note.by_operator = json.value("operator", false);
  note.withdraws = json.value("withdraws", std::vector<std::uint32_t>{});
  return note;
}

void read_changes(const fs::path& file, RunFolder& run) {
  const bool is_cut = each_line(file, [&](const std::string& line, int number) {
    try {
      run.changes.push_back(change_in(Json::parse(line)));
    } catch (const Json::exception&) {
      fail(file, number, "is no line of changes.jsonl");
    }
  });
  if (is_cut) run.notes.push_back(file.string() + ": its last line is cut");
}

/// The changed settings of the run; what this version does not know is left out.
daemon::Settings settings_in(const fs::path& report) {
  std::ifstream in(report);
  const Json json = Json::parse(in, nullptr, false);
  if (!json.is_object() || !json.contains("settings") || !json["settings"].contains("changed")) return {};
  daemon::Settings as_delivered;
  const std::vector<daemon::SettingKey> keys = daemon::keys_of(as_delivered);
  std::vector<std::string> changed;
  for (const auto& [key, value] : json["settings"]["changed"].items()) {
    const auto is_it = [&name = key](const daemon::SettingKey& known) { return known.name == name; };
    if (std::any_of(keys.begin(), keys.end(), is_it)) changed.push_back(key + "=" + value.dump());
  }
  try {
    return daemon::parse_settings("", report.string(), changed);
  } catch (const daemon::SettingsError&) {
    return {};
  }
}

}  // namespace

RunFolder read_run_folder(const fs::path& folder) {
  for (const char* name : {"localization.csv", "map.yaml"}) {
    if (!fs::exists(folder / name))
      throw std::runtime_error(folder.string() + ": is no folder of a run: it has no " + name);
  }
  RunFolder run;
  run.settings = settings_in(folder / "report.json");
  read_rows(folder / "localization.csv", run);
  if (fs::exists(folder / "changes.jsonl")) {
    read_changes(folder / "changes.jsonl", run);
  } else {
    run.notes.push_back(folder.string() + ": has no changes.jsonl");
  }
  return run;
}

}  // namespace deltamap::tool
