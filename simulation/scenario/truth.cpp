// SPDX-License-Identifier: Apache-2.0
#include "simulation/scenario/truth.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

namespace deltamap::simulation {
namespace {

using Json = nlohmann::json;
using OrderedJson = nlohmann::ordered_json;  // as a reader expects the keys

OrderedJson json_of(const Box& box) {
  return {box.centre.x(), box.centre.y(), box.width_m, box.height_m, box.theta_rad};
}

Box box_of(const Json& json) {
  if (!json.is_array() || json.size() != 5) throw std::runtime_error("a box must be a list of 5 numbers");
  return {{json[0].get<double>(), json[1].get<double>()},
          json[2].get<double>(),
          json[3].get<double>(),
          json[4].get<double>()};
}

Change change_of(const Json& json) {
  Change change;
  const auto kind = change_kind_named(json.at("kind").get<std::string>());
  if (!kind) throw std::runtime_error("'kind' must be removed, added, shifted or crept");
  change.kind = *kind;
  change.id = json.at("id").get<int>();
  change.box = box_of(json.at("box"));
  if (json.contains("from")) change.from = box_of(json["from"]);
  const bool is_moved = change.kind == ChangeKind::kShifted || change.kind == ChangeKind::kCrept;
  if (is_moved && !change.from) throw std::runtime_error("a shift needs 'from'");
  return change;
}

constexpr std::array<std::pair<MoverEvent::Kind, const char*>, 4> kEventNames{{{MoverEvent::Kind::kStopped, "stopped"},
                                                                               {MoverEvent::Kind::kWent, "went"},
                                                                               {MoverEvent::Kind::kOpened, "opened"},
                                                                               {MoverEvent::Kind::kShut, "shut"}}};

OrderedJson json_of(const MoverEvent& event) {
  OrderedJson json;
  for (const auto& [kind, name] : kEventNames) {
    if (kind == event.kind) json["kind"] = name;
  }
  json["index"] = event.index;
  if (event.kind == MoverEvent::Kind::kStopped) json["box"] = json_of(event.box);
  return json;
}

MoverEvent event_of(const Json& json) {
  const auto name = json.at("kind").get<std::string>();
  const auto known =
      std::find_if(kEventNames.begin(), kEventNames.end(), [&](const auto& entry) { return name == entry.second; });
  if (known == kEventNames.end()) throw std::runtime_error("'kind' must be stopped, went, opened or shut");
  MoverEvent event{known->first, json.at("index").get<int>(), {}};
  if (event.kind == MoverEvent::Kind::kStopped) event.box = box_of(json.at("box"));
  return event;
}

Pose2 pose_of(const Json& json) {
  return {json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>()};
}

OrderedJson json_of(const Pose2& pose) { return {pose.x, pose.y, pose.theta}; }

void take_line(const Json& line, Truth& truth) {
  if (line.contains("world")) {
    truth.world = line["world"].get<std::string>();
    truth.seed = line.value("seed", std::uint64_t{0});
    return;
  }
  const Timestamp time = timestamp_from_ns(line.at("t_ns").get<std::int64_t>());
  if (line.contains("change")) {
    truth.changes.push_back({time, change_of(line["change"])});
    return;
  }
  if (line.contains("mover")) {
    truth.events.push_back({time, event_of(line["mover"])});
    return;
  }
  if (line.contains("collision")) {
    const Json& collision = line["collision"];
    truth.collisions.push_back(
        {time, collision.at("with").get<int>(), collision.at("speed").get<double>(), pose_of(collision.at("pose"))});
    return;
  }
  truth.poses.push_back({time, pose_of(line.at("pose")), line.value("odom_v", 0.0), line.value("scan", false)});
}

}  // namespace

std::string truth_header(const std::string& world, std::uint64_t seed) {
  return OrderedJson{{"world", world}, {"seed", seed}}.dump();
}

std::string truth_line(const TruthRecord& record) {
  OrderedJson line;
  if (const auto* pose = std::get_if<TruthPose>(&record)) {
    line["t_ns"] = unix_ns(pose->time);
    line["pose"] = json_of(pose->map_from_robot);
    line["odom_v"] = pose->odom_speed_m_per_s;
    if (pose->at_scan) line["scan"] = true;
    return line.dump();
  }
  if (const auto* moved = std::get_if<TruthEvent>(&record)) {
    line["t_ns"] = unix_ns(moved->time);
    line["mover"] = json_of(moved->event);
    return line.dump();
  }
  if (const auto* collision = std::get_if<Collision>(&record)) {
    line["t_ns"] = unix_ns(collision->time);
    line["collision"] = {
        {"with", collision->object}, {"speed", collision->speed_m_per_s}, {"pose", json_of(collision->map_from_robot)}};
    return line.dump();
  }
  const auto& [time, change] = std::get<TruthChange>(record);
  line["t_ns"] = unix_ns(time);
  line["change"] = {{"kind", name_of(change.kind)}, {"id", change.id}, {"box", json_of(change.box)}};
  if (change.from) line["change"]["from"] = json_of(*change.from);
  return line.dump();
}

Truth read_truth(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in || std::filesystem::is_directory(file)) throw std::runtime_error(file.string() + ": cannot be read");
  Truth truth;
  int number = 0;
  for (std::string text; std::getline(in, text);) {
    ++number;
    if (text.empty()) continue;
    try {
      take_line(Json::parse(text), truth);
    } catch (const std::exception& error) {
      if (in.eof() && !truth.poses.empty()) break;  // written while the simulator was stopped
      throw std::runtime_error(file.string() + ": line " + std::to_string(number) + ": " + error.what());
    }
  }
  if (truth.poses.empty()) throw std::runtime_error(file.string() + ": line 1: holds no poses of a simulation");
  const auto by_time = [](const auto& a, const auto& b) { return a.time < b.time; };
  std::stable_sort(truth.poses.begin(), truth.poses.end(), by_time);
  std::stable_sort(truth.changes.begin(), truth.changes.end(), by_time);
  std::stable_sort(truth.events.begin(), truth.events.end(), by_time);
  std::stable_sort(truth.collisions.begin(), truth.collisions.end(), by_time);
  return truth;
}

Pose2 pose_at(const Truth& truth, Timestamp time) {
  assert(!truth.poses.empty() && "a truth holds poses");
  const auto after = std::lower_bound(truth.poses.begin(), truth.poses.end(), time,
                                      [](const TruthPose& pose, Timestamp t) { return pose.time < t; });
  if (after == truth.poses.begin()) return after->map_from_robot;
  if (after == truth.poses.end()) return truth.poses.back().map_from_robot;
  const auto before = std::prev(after);
  const Duration gap = after->time - before->time;
  const double share = gap.count() == 0 ? 0.0 : seconds(time - before->time) / seconds(gap);
  return interpolated(before->map_from_robot, after->map_from_robot, share);
}

}  // namespace deltamap::simulation
