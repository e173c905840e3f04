// SPDX-License-Identifier: Apache-2.0
#include "tool/export/foxglove.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/base64.hpp"

namespace deltamap::tool::foxglove {
namespace {

using Schema = nlohmann::ordered_json;

Schema type(const char* name) { return {{"type", name}}; }

/// An object whose properties are all required, but for those of a time.
Schema object(const char* title, const Schema& properties) {
  Schema schema{{"title", title}, {"type", "object"}, {"properties", properties}};
  schema["required"] = Schema::array();
  for (const auto& [name, property] : properties.items()) schema["required"].push_back(name);
  return schema;
}

Schema time_schema() {
  Schema nsec = type("integer");
  nsec["minimum"] = 0;
  nsec["maximum"] = 999999999;
  Schema sec = type("integer");
  sec["minimum"] = 0;
  return {{"type", "object"}, {"title", "time"}, {"properties", {{"sec", sec}, {"nsec", nsec}}}};
}

Schema numbers(const char* title, const std::vector<const char*>& names) {
  Schema properties = Schema::object();
  for (const char* name : names) properties[name] = type("number");
  return object(title, properties);
}

Schema pose_schema() {
  return object("foxglove.Pose", {{"position", numbers("foxglove.Vector3", {"x", "y", "z"})},
                                  {"orientation", numbers("foxglove.Quaternion", {"x", "y", "z", "w"})}});
}

Schema names_of_numbers(const char* title, const std::vector<const char*>& names) {
  Schema schema{{"title", title}, {"oneOf", Schema::array()}};
  for (std::size_t i = 0; i < names.size(); ++i) schema["oneOf"].push_back({{"title", names[i]}, {"const", i}});
  return schema;
}

Schema list_of(const Schema& items) { return {{"type", "array"}, {"items", items}}; }

Schema unsigned_schema() {
  Schema schema = type("integer");
  schema["minimum"] = 0;
  return schema;
}

Schema laser_scan_schema() {
  return object("foxglove.LaserScan", {{"timestamp", time_schema()},
                                       {"frame_id", type("string")},
                                       {"pose", pose_schema()},
                                       {"start_angle", type("number")},
                                       {"end_angle", type("number")},
                                       {"ranges", list_of(type("number"))},
                                       {"intensities", list_of(type("number"))}});
}

Schema grid_schema() {
  const Schema numeric = names_of_numbers(
      "foxglove.NumericType", {"UNKNOWN", "UINT8", "INT8", "UINT16", "INT16", "UINT32", "INT32", "FLOAT32", "FLOAT64"});
  const Schema field = object("foxglove.PackedElementField",
                              {{"name", type("string")}, {"offset", unsigned_schema()}, {"type", numeric}});
  return object("foxglove.Grid", {{"timestamp", time_schema()},
                                  {"frame_id", type("string")},
                                  {"pose", pose_schema()},
                                  {"column_count", unsigned_schema()},
                                  {"cell_size", numbers("foxglove.Vector2", {"x", "y"})},
                                  {"row_stride", unsigned_schema()},
                                  {"cell_stride", unsigned_schema()},
                                  {"fields", list_of(field)},
                                  {"data", {{"type", "string"}, {"contentEncoding", "base64"}}}});
}

Schema log_schema() {
  return object(
      "foxglove.Log",
      {{"timestamp", time_schema()},
       {"level", names_of_numbers("foxglove.LogLevel", {"UNKNOWN", "DEBUG", "INFO", "WARNING", "ERROR", "FATAL"})},
       {"message", type("string")},
       {"name", type("string")},
       {"file", type("string")},
       {"line", unsigned_schema()}});
}

Schema time_of(Timestamp time) {
  constexpr std::int64_t kNsPerSecond = 1'000'000'000;
  return {{"sec", unix_ns(time) / kNsPerSecond}, {"nsec", unix_ns(time) % kNsPerSecond}};
}

Schema pose_of(const Pose2& pose) {
  return {
      {"position", {{"x", pose.x}, {"y", pose.y}, {"z", 0.0}}},
      {"orientation", {{"x", 0.0}, {"y", 0.0}, {"z", std::sin(pose.theta / 2.0)}, {"w", std::cos(pose.theta / 2.0)}}}};
}

/// Of a float the digits that it holds: 1.07, not 1.0700000524520874.
double rounded_to_tenths_of_millimetres(float range_m) { return std::round(static_cast<double>(range_m) * 1e4) / 1e4; }

}  // namespace

std::string schema_of(std::string_view message) {
  if (message == "LaserScan") return laser_scan_schema().dump();
  if (message == "Grid") return grid_schema().dump();
  if (message == "Log") return log_schema().dump();
  return object("foxglove.PoseInFrame",
                {{"timestamp", time_schema()}, {"frame_id", type("string")}, {"pose", pose_schema()}})
      .dump();
}

std::string laser_scan(const Scan& scan, std::string_view frame, const Pose2& frame_from_laser) {
  Schema ranges = Schema::array();
  for (const Beam& beam : scan.beams) {
    ranges.push_back(beam.kind == BeamKind::kRange ? rounded_to_tenths_of_millimetres(beam.range_m) : 0.0);
  }
  const std::size_t last = scan.beams.empty() ? 0 : scan.beams.size() - 1;
  const Schema message{{"timestamp", time_of(scan.time)},     {"frame_id", frame},
                       {"pose", pose_of(frame_from_laser)},   {"start_angle", scan.first_bearing_rad},
                       {"end_angle", scan.bearing_rad(last)}, {"ranges", ranges},
                       {"intensities", Schema::array()}};
  return message.dump();
}

std::string pose_in_frame(Timestamp time, std::string_view frame, const Pose2& frame_from_robot) {
  const Schema message{{"timestamp", time_of(time)}, {"frame_id", frame}, {"pose", pose_of(frame_from_robot)}};
  return message.dump();
}

std::string grid(Timestamp time, std::string_view frame, const OccupancyGrid& map) {
  constexpr int kUint8 = 1;
  std::string cells;
  cells.reserve(map.geometry().cell_count());
  for (const CellState state : all_cells(map)) {
    constexpr char kUnknown = 127;
    cells += state == CellState::kFree ? '\0' : state == CellState::kOccupied ? '\xFF' : kUnknown;
  }
  const double resolution_m = map.resolution_m();
  const Point2& origin = map.geometry().origin;
  const Schema message{{"timestamp", time_of(time)},
                       {"frame_id", frame},
                       {"pose", pose_of({origin.x(), origin.y(), 0.0})},
                       {"column_count", map.width()},
                       {"cell_size", {{"x", resolution_m}, {"y", resolution_m}}},
                       {"row_stride", map.width()},
                       {"cell_stride", 1},
                       {"fields", {{{"name", "occupancy"}, {"offset", 0}, {"type", kUint8}}}},
                       {"data", base64_of(cells)}};
  return message.dump();
}

std::string log(Timestamp time, Level level, std::string_view name, std::string_view message) {
  const Schema json{{"timestamp", time_of(time)},
                    {"level", static_cast<int>(level)},
                    {"message", message},
                    {"name", name},
                    {"file", ""},
                    {"line", 0}};
  return json.dump(-1, ' ', false, Schema::error_handler_t::replace);
}

}  // namespace deltamap::tool::foxglove
