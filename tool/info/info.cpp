// SPDX-License-Identifier: Apache-2.0
// `deltamap info REC…`: what recordings hold, and whether a replay repeats the run that made them.
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <stdexcept>

#include "core/files/grid_file.hpp"
#include "daemon/replay/replay_start.hpp"
#include "daemon/settings/settings.hpp"
#include "tool/info/info_text.hpp"
#include "tool/progress.hpp"
#include "tool/subcommands.hpp"

namespace deltamap::tool {
namespace {

struct InfoOptions {
  std::vector<std::string> recordings;
  std::string map;
  std::string config;
  std::vector<std::string> overrides;
  bool as_json = false;
};

RecordingSurvey shown_survey_of(const std::string& file) {
  std::error_code ignored;
  const std::uintmax_t size = std::filesystem::file_size(file, ignored);
  Progress progress{"reading " + file, ignored ? 0 : size};
  return survey_of_recording(file, [&](std::uint64_t read) { progress.show(read); });
}

/// By these settings and this map, as a replay would judge.
RepeatAnswer repeat_with(const RecordingSurvey& survey, const InfoOptions& options, const daemon::Settings& settings) {
  RepeatAnswer answer = repeat_answer(survey);
  if (!answer.can) return answer;
  const bool has_settings = !options.config.empty() || !options.overrides.empty();
  if (options.map.empty()) {
    if (!has_settings) return answer;
    if (settings_fingerprint(settings) == survey.run.journal.run()->settings)
      return {true, "the settings are the run's; whether the map is, --map tells"};
    return {false, "not obeyed: other settings"};
  }
  daemon::ReplayJob job;
  job.settings = settings;
  const auto map = std::make_shared<const OccupancyGrid>(read_grid(options.map));
  const std::string journal = replay_start(survey.run, job, map).journal;
  return {journal == "obeyed", journal == "obeyed" ? "these are the run's settings and map" : journal};
}

void print_info(const InfoOptions& options) {
  const daemon::Settings settings = daemon::settings_or_defaults(options.config, options.overrides);
  std::string failures;
  std::string json;
  for (const std::string& file : options.recordings) {
    try {
      const RecordingSurvey survey = shown_survey_of(file);
      const RepeatAnswer repeat = repeat_with(survey, options, settings);
      if (options.as_json)
        json += (json.empty() ? "" : ",\n") + info_json(survey, repeat);
      else
        std::cout << info_text(survey, repeat);
    } catch (const std::runtime_error& error) {
      if (options.recordings.size() == 1) throw;
      failures += (failures.empty() ? "" : "\ndeltamap: ") + std::string(error.what());
    }
  }
  if (options.as_json) std::cout << "[" << json << "]\n";
  if (!failures.empty()) throw std::runtime_error(failures);
}

}  // namespace

void add_info(CLI::App& app) {
  auto options = std::make_shared<InfoOptions>();
  CLI::App* command =
      app.add_subcommand("info", "what recordings hold, what they lack, and whether a replay repeats the run");
  command->add_option("RECORDING", options->recordings, "recordings (.pcapng)")->required();
  command->add_option("--map", options->map, "M_0: is it the run's?");
  command->add_option("--config", options->config, "settings, YAML: are they the run's?");
  command->add_option("--set", options->overrides, "key=value over the settings; repeatable")->allow_extra_args(false);
  command->add_flag("--json", options->as_json, "print a JSON array, an object a recording");
  command->callback([options] { print_info(*options); });
}

}  // namespace deltamap::tool
