// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "core/utc_text.hpp"
#include "daemon/settings/fingerprint.hpp"
#include "tool/info/info_text.hpp"

namespace deltamap::tool {
namespace {

using InfoJson = nlohmann::ordered_json;

InfoJson json_of_told(const ToldValues& told) {
  InfoJson changes = InfoJson::array();
  for (const auto& [after_s, value] : told.changes) changes.push_back({{"after_s", after_s}, {"value", value}});
  return changes;
}

InfoJson json_of_silences(const std::vector<Silence>& silences) {
  InfoJson all = InfoJson::array();
  for (const Silence& one : silences) all.push_back({{"after_s", one.after_s}, {"length_s", one.length_s}});
  return all;
}

InfoJson json_of_traffic(const TrafficSurvey& traffic) {
  return {{"chunks", traffic.chunks},
          {"bytes", traffic.bytes},
          {"frames", traffic.frames},
          {"garbage_bytes", traffic.counts.garbage_bytes},
          {"bad_length", traffic.counts.bad_length},
          {"bad_checksum", traffic.counts.bad_checksum},
          {"truncated", traffic.counts.truncated}};
}

InfoJson json_of_port(const PortSurvey& port) {
  return {{"said", json_of_traffic(port.said)}, {"heard", json_of_traffic(port.heard)},
          {"bauds", json_of_told(port.bauds)},  {"sessions_s", port.sessions_s},
          {"messages", port.rhythm.count()},    {"period_s", port.rhythm.period_s()},
          {"missing", port.rhythm.missing()},   {"silences", json_of_silences(port.rhythm.silences())}};
}

InfoJson json_of_robot(const RecordingSurvey& survey) {
  InfoJson robot = json_of_port(survey.robot_port());
  robot["identity"] = nullptr;
  if (const auto& told = survey.identity) {
    robot["identity"] = {{"name", told->name}, {"type", told->type}, {"subtype", told->subtype}};
  }
  robot["firmware"] = survey.config ? InfoJson(survey.config->firmware_version) : InfoJson();
  return robot;
}

InfoJson json_of_laser(const RecordingSurvey& survey) {
  InfoJson laser = json_of_port(survey.laser_port());
  laser["type"] = survey.laser.type;
  laser["software"] = survey.laser.status ? InfoJson(survey.laser.status->software_version) : InfoJson();
  laser["variants"] = json_of_told(survey.laser.variants);
  laser["units"] = json_of_told(survey.laser.units);
  laser["measuring_modes"] = json_of_told(survey.laser.measuring_modes);
  return laser;
}

InfoJson json_of_run(const RecordingSurvey& survey) {
  const auto& identity = survey.run.journal.run();
  if (!identity) return nullptr;
  InfoJson run{{"settings", daemon::hex_of(identity->settings)},
               {"map", daemon::hex_of(identity->map)},
               {"began_from_earlier_run", survey.run.begin.begin().has_value()},
               {"changed", InfoJson::object()}};
  for (const auto& [key, value] : survey.settings) run["changed"][key] = value;
  if (const std::string begin = words_of_begin(survey); !begin.empty()) run["begins_with"] = begin;
  return run;
}

InfoJson json_of_commands(const RecordingSurvey& survey) {
  InfoJson commands = InfoJson::array();
  for (const daemon::Decision& command : survey.run.journal.commands()) {
    if (is_of_begin(command)) continue;
    commands.push_back({{"what", words_of_command(command)}, {"scan", command.scan}, {"after_s", nullptr}});
    if (command.scan_time && survey.first) {
      commands.back()["after_s"] = seconds(*command.scan_time - *survey.first);
    }
  }
  return commands;
}

}  // namespace

std::string info_json(const RecordingSurvey& survey, const RepeatAnswer& repeat) {
  const InfoJson json{{"file", survey.file.string()},
                      {"bytes", survey.size_bytes},
                      {"packets", survey.records},
                      {"notes", survey.notes},
                      {"began", survey.first ? InfoJson(utc_text(*survey.first)) : InfoJson()},
                      {"length_s", survey.length_s},
                      {"robot", json_of_robot(survey)},
                      {"laser", json_of_laser(survey)},
                      {"set_back", json_of_silences(survey.set_back)},
                      {"both_silent", json_of_silences(survey.common_silences())},
                      {"records_missing_s", survey.lost_s},
                      {"dropped", survey.dropped},
                      {"faults", survey.run.faults.lines()},
                      {"operator", json_of_commands(survey)},
                      {"run", json_of_run(survey)},
                      {"bit_for_bit", {{"possible", repeat.can}, {"why", repeat.why}}}};
  return json.dump(2, ' ', false, InfoJson::error_handler_t::replace);
}

}  // namespace deltamap::tool
