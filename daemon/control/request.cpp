// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/request.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

namespace deltamap::daemon::control {
namespace {

using Json = nlohmann::ordered_json;
using Kind = Request::Kind;

constexpr double kFarthest_m = 1e6;
constexpr double kLargest_deg = 1e6;

constexpr std::array<std::pair<std::string_view, Kind>, 8> kPlainCommands{{{"status", Kind::kStatus},
                                                                           {"incidents", Kind::kIncidents},
                                                                           {"things", Kind::kThings},
                                                                           {"bays", Kind::kBays},
                                                                           {"pause", Kind::kPause},
                                                                           {"resume", Kind::kResume},
                                                                           {"save", Kind::kSave},
                                                                           {"reload", Kind::kReload}}};

constexpr std::array<std::pair<std::string_view, Kind>, 2> kMapOrders{
    {{"undo", Kind::kUndo}, {"rollback", Kind::kRollBack}}};

bool is_map_order(Kind kind) { return kind == Kind::kUndo || kind == Kind::kRollBack; }

std::optional<double> number_in(const Json& json, const char* key, double largest) {
  const auto found = json.find(key);
  if (found == json.end() || !found->is_number()) return std::nullopt;
  const double number = found->get<double>();
  return std::isfinite(number) && std::abs(number) <= largest ? std::optional{number} : std::nullopt;
}

RequestAnswer relocalization_in(const Json& json) {
  const auto x_m = number_in(json, "x_m", kFarthest_m);
  const auto y_m = number_in(json, "y_m", kFarthest_m);
  const auto heading_deg = number_in(json, "heading_deg", kLargest_deg);
  if (!x_m || !y_m || !heading_deg) return {std::nullopt, "'relocalize' needs the numbers x_m, y_m and heading_deg"};
  return {Request{Kind::kRelocalize, {*x_m, *y_m, wrapped_angle(radians(*heading_deg))}}, ""};
}

std::optional<std::uint32_t> count_in(const Json& json, const char* key) {
  const auto found = json.find(key);
  const bool is_count = found != json.end() && found->is_number_unsigned() &&
                        found->get<std::uint64_t>() <= std::numeric_limits<std::uint32_t>::max();
  return is_count ? std::optional{found->get<std::uint32_t>()} : std::nullopt;
}

/// Reads the requests "undo" and "rollback", which name a revision, or a thing.
RequestAnswer map_order_in(const Json& json, Kind kind, const std::string& name) {
  if (kind == Kind::kUndo && json.contains("thing")) {
    const auto thing = count_in(json, "thing");
    if (!thing) return {std::nullopt, "'undo' of a thing needs its id: 1, 2 …"};
    Request request{Kind::kUndoThing, {}};
    request.thing = *thing;
    return {request, ""};
  }
  const auto revision = count_in(json, "revision");
  if (!revision) return {std::nullopt, "'" + name + "' needs the number of a revision: 0, 1, 2 …"};
  Request request{kind, {}};
  request.revision = *revision;
  return {request, ""};
}

RequestAnswer record_in(const Json& json) {
  const auto mode = json.find("mode");
  if (mode != json.end() && *mode == "start") return {Request{Kind::kRecordStart, {}}, ""};
  if (mode != json.end() && *mode == "stop") return {Request{Kind::kRecordStop, {}}, ""};
  return {std::nullopt, "'record' needs the mode start or stop"};
}

RequestAnswer mark_in(const Json& json) {
  const auto words = json.find("words");
  Request request{Kind::kMark, {}};
  if (words == json.end()) return {request, ""};
  const bool is_line = words->is_string() && words->get_ref<const std::string&>().size() <= kLongestWords &&
                       words->get_ref<const std::string&>().find('\n') == std::string::npos;
  if (!is_line) return {std::nullopt, "'mark' needs words: one line of at most 400 bytes"};
  request.words = words->get<std::string>();
  return {request, ""};
}

RequestAnswer log_level_in(const Json& json) {
  const auto level = json.find("level");
  const auto known =
      level != json.end() && level->is_string() ? log_level_of(level->get_ref<const std::string&>()) : std::nullopt;
  if (!known) return {std::nullopt, "'log-level' needs the level trace, debug, info, warn or error"};
  Request request{Kind::kLogLevel, {}};
  request.log_level = *known;
  return {request, ""};
}

/// Empty where it is not there; nothing where it is no text.
std::optional<std::string> text_in(const Json& json, const char* key) {
  const auto found = json.find(key);
  if (found == json.end()) return "";
  return found->is_string() ? std::optional{found->get<std::string>()} : std::nullopt;
}

RequestAnswer site_edit_in(const Json& json, PlaceKind kind) {
  const auto version = text_in(json, "version");
  const auto of = text_in(json, "of");
  const auto place = json.find("place");
  const bool is_whole = version && !version->empty() && of && (place != json.end() ? place->is_object() : !of->empty());
  if (!is_whole) return {std::nullopt, "a bay or zone needs version, and place or of"};
  Request request{Kind::kEditSite, {}};
  request.edit = {kind, *version, *of, place != json.end() ? place->dump() : ""};
  return {request, ""};
}

RequestAnswer drive_in(const Json& json) {
  const auto mode = json.find("mode");
  if (mode != json.end() && *mode == "off") return {Request{Kind::kDriveOff, {}}, ""};
  if (mode != json.end() && *mode == "wander") return {Request{Kind::kDriveWander, {}}, ""};
  return {std::nullopt, "'drive' needs the mode off or wander"};
}

/// "zone 'gate' changed"
std::string words_of(const SiteEdit& edit) {
  const std::string what = std::string(daemon::name_of(edit.kind)) + (edit.of.empty() ? "" : " '" + edit.of + "'");
  return what + (edit.place.empty() ? " taken away" : edit.of.empty() ? " drawn" : " changed");
}

std::string_view name_of(Kind kind) {
  for (const auto& [name, plain] : kPlainCommands) {
    if (plain == kind) return name;
  }
  for (const auto& [name, order] : kMapOrders) {
    if (order == kind) return name;
  }
  if (kind == Kind::kUndoThing) return "undo";
  if (kind == Kind::kLogLevel) return "log-level";
  if (kind == Kind::kMark) return "mark";
  if (kind == Kind::kRecordStart || kind == Kind::kRecordStop) return "record";
  return kind == Kind::kRelocalize ? "relocalize" : "drive";
}

}  // namespace

RequestAnswer request_of_line(std::string_view line) {
  const Json json = Json::parse(line, nullptr, false);
  if (!json.is_object()) return {std::nullopt, "a request is one JSON object in one line"};
  const auto command = json.find("command");
  if (command == json.end() || !command->is_string()) return {std::nullopt, "a request needs a command"};
  const auto& name = command->get_ref<const std::string&>();
  for (const auto& [plain, kind] : kPlainCommands) {
    if (name == plain) return {Request{kind, {}}, ""};
  }
  for (const auto& [order, kind] : kMapOrders) {
    if (name == order) return map_order_in(json, kind, name);
  }
  if (name == "relocalize") return relocalization_in(json);
  if (name == "record") return record_in(json);
  if (name == "mark") return mark_in(json);
  if (name == "log-level") return log_level_in(json);
  if (name == "drive") return drive_in(json);
  if (name == "bay") return site_edit_in(json, PlaceKind::kBay);
  if (name == "zone") return site_edit_in(json, PlaceKind::kZone);
  return {std::nullopt, "unknown command '" + name + "'"};
}

bool is_stop(std::string_view line) {
  const RequestAnswer answer = request_of_line(line);
  return answer.request && answer.request->kind == Kind::kDriveOff;
}

std::string line_of(const Request& request) {
  Json json;
  json["command"] = request.kind == Kind::kEditSite ? daemon::name_of(request.edit.kind) : name_of(request.kind);
  if (request.kind == Kind::kRelocalize) {
    json["x_m"] = request.map_from_robot.x;
    json["y_m"] = request.map_from_robot.y;
    json["heading_deg"] = degrees(request.map_from_robot.theta);
  }
  if (is_map_order(request.kind)) json["revision"] = request.revision;
  if (request.kind == Kind::kMark) json["words"] = request.words;
  if (request.kind == Kind::kUndoThing) json["thing"] = request.thing;
  if (request.kind == Kind::kLogLevel) json["level"] = name_of(request.log_level);
  if (request.kind == Kind::kRecordStart) json["mode"] = "start";
  if (request.kind == Kind::kRecordStop) json["mode"] = "stop";
  if (request.kind == Kind::kDriveOff) json["mode"] = "off";
  if (request.kind == Kind::kDriveWander) json["mode"] = "wander";
  if (request.kind == Kind::kEditSite) {
    json["version"] = request.edit.version;
    if (!request.edit.of.empty()) json["of"] = request.edit.of;
    if (!request.edit.place.empty()) json["place"] = Json::parse(request.edit.place, nullptr, false);
  }
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string done_line(std::string_view message, bool doubt) {
  Json json;
  json["ok"] = true;
  json["message"] = message;
  if (doubt) json["doubt"] = true;
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string error_line(std::string_view error) {
  Json json;
  json["ok"] = false;
  json["error"] = error;
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string words_of(const Request& request) {
  if (request.kind == Kind::kRecordStart) return "record start";
  if (request.kind == Kind::kRecordStop) return "record stop";
  if (request.kind == Kind::kDriveOff) return "drive off";
  if (request.kind == Kind::kDriveWander) return "drive wander";
  if (request.kind == Kind::kEditSite) return words_of(request.edit);
  if (request.kind == Kind::kMark) return request.words.empty() ? "mark" : "mark \"" + request.words + "\"";
  if (request.kind == Kind::kLogLevel) return "log-level " + std::string(name_of(request.log_level));
  if (request.kind == Kind::kUndoThing) return "undo thing " + std::to_string(request.thing);
  if (is_map_order(request.kind)) return std::string(name_of(request.kind)) + " " + std::to_string(request.revision);
  if (request.kind != Kind::kRelocalize) return std::string(name_of(request.kind));
  const Pose2& pose = request.map_from_robot;
  char text[96];
  (void)std::snprintf(text, sizeof text, "relocalize %.2f,%.2f,%.0f", pose.x, pose.y, degrees(pose.theta));
  return text;
}

}  // namespace deltamap::daemon::control
