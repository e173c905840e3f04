// SPDX-License-Identifier: Apache-2.0
#include "tool/import/ros_messages.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "core/geometry/angle.hpp"
#include "tool/import/byte_reader.hpp"

namespace deltamap::tool {
namespace {

using Json = nlohmann::json;

enum class Kind { kScan, kOdometry, kPoseStamped, kPoseInFrame, kTransforms, kTransform };

struct KnownType {
  std::string_view type;
  Kind kind;
};
constexpr std::array<KnownType, 14> kKnownTypes{{{"sensor_msgs/LaserScan", Kind::kScan},
                                                 {"sensor_msgs/msg/LaserScan", Kind::kScan},
                                                 {"foxglove.LaserScan", Kind::kScan},
                                                 {"nav_msgs/Odometry", Kind::kOdometry},
                                                 {"nav_msgs/msg/Odometry", Kind::kOdometry},
                                                 {"geometry_msgs/PoseStamped", Kind::kPoseStamped},
                                                 {"geometry_msgs/msg/PoseStamped", Kind::kPoseStamped},
                                                 {"foxglove.PoseInFrame", Kind::kPoseInFrame},
                                                 {"tf/tfMessage", Kind::kTransforms},
                                                 {"tf2_msgs/TFMessage", Kind::kTransforms},
                                                 {"tf2_msgs/msg/TFMessage", Kind::kTransforms},
                                                 {"foxglove.FrameTransforms", Kind::kTransforms},
                                                 {"foxglove.FrameTransform", Kind::kTransform},
                                                 {"geometry_msgs/TransformStamped", Kind::kTransform}}};

bool is_known_encoding(std::string_view encoding) {
  return encoding == "ros1" || encoding == "cdr" || encoding == "json";
}

std::optional<Kind> kind_of_type(std::string_view type) {
  const auto found =
      std::find_if(kKnownTypes.begin(), kKnownTypes.end(), [&](const KnownType& known) { return known.type == type; });
  return found == kKnownTypes.end() ? std::nullopt : std::optional{found->kind};
}

Timestamp stamp_of(std::int64_t sec, std::int64_t nsec) {
  constexpr std::int64_t kLatestSec = 9'000'000'000;
  if (sec < 0 || sec > kLatestSec || nsec < 0 || nsec >= 1'000'000'000)
    throw std::runtime_error("its stamp is no time");
  return timestamp_from_ns(sec * 1'000'000'000 + nsec);
}

/// Of the unit quaternion (x, y, z, w).
PlanarPose planar_pose(const Point2& at, double x, double y, double z, double w) {
  const double yaw_rad = std::atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z));
  if (!at.allFinite() || !std::isfinite(yaw_rad)) throw std::runtime_error("its pose is no number");
  return {{at.x(), at.y(), yaw_rad}, 2.0 * (x * x + y * y) > 1.0};
}

std::string without_slash(std::string_view frame) { return std::string(frame.substr(frame.starts_with('/') ? 1 : 0)); }

/// ROS 1 packs its fields; CDR aligns each to its size, from behind its head of four bytes; its second version, XCDR2,
/// aligns none to more than four.
class Fields {
 public:
  Fields(std::string_view data, bool is_cdr)
      : reader_{data.substr(is_cdr ? std::min(kHeadBytes, data.size()) : 0)},
        is_cdr_{is_cdr},
        most_aligned_{is_cdr ? alignment_of(data) : 1} {}

  template <typename Number>
  Number number() {
    reader_.align(std::min(sizeof(Number), most_aligned_));
    return reader_.number<Number>();
  }
  std::string_view text() {
    const auto size = number<std::uint32_t>();
    std::string_view text = reader_.raw(size);
    if (is_cdr_ && text.ends_with('\0')) text.remove_suffix(1);
    return text;
  }
  Timestamp stamp() {
    const auto sec = number<std::uint32_t>();
    return stamp_of(sec, number<std::uint32_t>());
  }
  /// Position and quaternion, each number 8 bytes.
  PlanarPose pose() {
    std::array<double, 7> n{};
    for (double& value : n) value = number<double>();
    return planar_pose({n[0], n[1]}, n[3], n[4], n[5], n[6]);
  }
  std::vector<float> floats() {
    const auto count = number<std::uint32_t>();
    if (count > reader_.left() / sizeof(float)) throw OutOfBytes{};
    std::vector<float> values(count);
    for (float& value : values) value = number<float>();
    return values;
  }
  /// Of a list of messages. XCDR2 writes before it how many bytes the list takes, which @foxglove/cdr leaves to its
  /// caller.
  std::uint32_t count_of_messages() {
    const auto count = number<std::uint32_t>();
    const bool is_size = most_aligned_ == 4 && count > 0 && count <= reader_.left() && reader_.left() - count < 4;
    return is_size ? number<std::uint32_t>() : count;
  }
  /// Seq, stamp, frame; ROS 2 has no seq.
  std::pair<Timestamp, std::string> header() {
    if (!is_cdr_) (void)number<std::uint32_t>();
    const Timestamp time = stamp();
    return {time, without_slash(text())};
  }

 private:
  static constexpr std::size_t kHeadBytes = 4;

  /// By the kind of encoding, which the head's first two bytes tell: XCDR2 of final types has two numbers, RTPS's 0x07
  /// and DDS-XTypes' 0x11, and @foxglove/cdr 3.5.0 writes either.
  static std::size_t alignment_of(std::string_view data) {
    ByteReader head{data};
    const auto high = head.number<std::uint8_t>();
    const auto low = head.number<std::uint8_t>();
    if ((low & 1U) == 0) throw std::runtime_error("its bytes are big-endian CDR, which is not read");
    if (high == 0 && low == 0x01) return 8;
    if (high == 0 && (low == 0x07 || low == 0x11)) return 4;
    throw std::runtime_error("its bytes are CDR of kind " + std::to_string(256 * high + low) +
                             ": 1, 7 and 17 are read, which have nothing between their fields");
  }

  ByteReader reader_;
  bool is_cdr_;
  std::size_t most_aligned_;
};

RosScan scan_of_fields(Fields fields) {
  RosScan scan;
  std::tie(scan.time, scan.frame) = fields.header();
  scan.first_bearing_rad = static_cast<double>(fields.number<float>());
  (void)fields.number<float>();  // last bearing
  scan.bearing_step_rad = static_cast<double>(fields.number<float>());
  (void)fields.number<float>();  // between beams
  (void)fields.number<float>();  // between scans
  scan.min_range_m = static_cast<double>(fields.number<float>());
  scan.max_range_m = static_cast<double>(fields.number<float>());
  scan.ranges_m = fields.floats();
  return scan;
}

RosPose transform_of_fields(Fields& fields) {
  RosPose pose;
  std::tie(pose.time, pose.frame) = fields.header();
  pose.child = without_slash(fields.text());
  pose.at = fields.pose();
  return pose;
}

std::vector<RosPose> poses_of_fields(Fields fields, Kind kind) {
  std::vector<RosPose> poses;
  if (kind == Kind::kTransforms) {
    const std::uint32_t count = fields.count_of_messages();
    for (std::uint32_t i = 0; i < count; ++i) poses.push_back(transform_of_fields(fields));
  } else if (kind == Kind::kPoseStamped) {
    RosPose pose;
    std::tie(pose.time, pose.frame) = fields.header();
    pose.at = fields.pose();
    poses.push_back(std::move(pose));
  } else {
    poses.push_back(transform_of_fields(fields));  // an Odometry begins alike
  }
  return poses;
}

/// The first of these names that there is.
const Json* member(const Json& json, std::initializer_list<const char*> names) {
  for (const char* name : names) {
    if (json.is_object() && json.contains(name)) return &json.at(name);
  }
  return nullptr;
}
const Json& needed(const Json& json, std::initializer_list<const char*> names) {
  if (const Json* found = member(json, names)) return *found;
  throw std::runtime_error(std::string("it has no \"") + *names.begin() + "\"");
}
double number_in(const Json& json, std::initializer_list<const char*> names) {
  const Json& found = needed(json, names);
  if (!found.is_number()) throw std::runtime_error(std::string("its \"") + *names.begin() + "\" is no number");
  return found.get<double>();
}
std::string text_in(const Json& json, std::initializer_list<const char*> names) {
  const Json* found = member(json, names);
  return found != nullptr && found->is_string() ? without_slash(found->get<std::string>()) : "";
}

std::int64_t whole_in(const Json& json, std::initializer_list<const char*> names) {
  const Json& found = needed(json, names);
  if (!found.is_number_integer())
    throw std::runtime_error(std::string("its \"") + *names.begin() + "\" is no whole number");
  return found.get<std::int64_t>();
}
Timestamp time_in(const Json& json) {
  const Json* header = member(json, {"header"});
  const Json& stamp = header != nullptr ? needed(*header, {"stamp"}) : needed(json, {"timestamp"});
  return stamp_of(whole_in(stamp, {"sec", "secs"}), whole_in(stamp, {"nsec", "nanosec", "nsecs"}));
}
std::string frame_in(const Json& json) {
  const Json* header = member(json, {"header"});
  return text_in(header != nullptr ? *header : json, {"frame_id", "parent_frame_id"});
}

PlanarPose pose_in(const Json& json) {
  const Json& at = needed(json, {"position", "translation"});
  const Json& turn = needed(json, {"orientation", "rotation"});
  return planar_pose({number_in(at, {"x"}), number_in(at, {"y"})}, number_in(turn, {"x"}), number_in(turn, {"y"}),
                     number_in(turn, {"z"}), number_in(turn, {"w"}));
}

RosScan scan_of_json(const Json& json) {
  RosScan scan;
  scan.time = time_in(json);
  scan.frame = frame_in(json);
  const Json* pose = member(json, {"pose"});
  if (pose != nullptr && pose->is_object() && !pose->empty()) scan.frame_from_scan = pose_in(*pose);
  scan.first_bearing_rad = number_in(json, {"angle_min", "start_angle"});
  const Json& ranges = needed(json, {"ranges"});
  if (!ranges.is_array()) throw std::runtime_error("its \"ranges\" are no list");
  for (const Json& range : ranges) {
    if (!range.is_number() && !range.is_null()) throw std::runtime_error("its \"ranges\" are no numbers");
    scan.ranges_m.push_back(range.is_number() ? range.get<float>() : std::nanf(""));
  }
  if (member(json, {"angle_increment"}) != nullptr) {
    scan.bearing_step_rad = number_in(json, {"angle_increment"});
  } else if (scan.ranges_m.size() > 1) {
    scan.bearing_step_rad =
        (number_in(json, {"end_angle"}) - scan.first_bearing_rad) / static_cast<double>(scan.ranges_m.size() - 1);
  }
  if (member(json, {"range_min"}) != nullptr) scan.min_range_m = number_in(json, {"range_min"});
  if (member(json, {"range_max"}) != nullptr) scan.max_range_m = number_in(json, {"range_max"});
  return scan;
}

RosPose transform_of_json(const Json& json) {
  const Json* inner = member(json, {"transform"});
  return {time_in(json), frame_in(json), text_in(json, {"child_frame_id"}), pose_in(inner != nullptr ? *inner : json)};
}

std::vector<RosPose> poses_of_json(const Json& json, Kind kind) {
  if (kind == Kind::kTransforms) {
    std::vector<RosPose> poses;
    const Json& all = needed(json, {"transforms"});
    if (!all.is_array()) throw std::runtime_error("its \"transforms\" are no list");
    for (const Json& one : all) poses.push_back(transform_of_json(one));
    return poses;
  }
  if (kind == Kind::kTransform) return {transform_of_json(json)};
  const Json& outer = needed(json, {"pose"});
  return {{time_in(json), frame_in(json), text_in(json, {"child_frame_id"}),
           pose_in(kind == Kind::kOdometry ? needed(outer, {"pose"}) : outer)}};
}

Json json_in(std::string_view text) {
  Json json = Json::parse(text, nullptr, false);
  if (json.is_discarded()) throw std::runtime_error("it is no JSON");
  return json;
}

RosScan checked(RosScan scan) {
  constexpr std::size_t kMostBeams = 100'000;
  if (scan.ranges_m.size() < 2 || scan.ranges_m.size() > kMostBeams) throw std::runtime_error("it has no ranges");
  if (!std::isfinite(scan.first_bearing_rad) || !std::isfinite(scan.bearing_step_rad) || scan.bearing_step_rad == 0.0)
    throw std::runtime_error("its bearings are no angles");
  if (!std::isfinite(scan.max_range_m) || !(scan.max_range_m > 0.0)) scan.max_range_m = 0.0;
  if (!std::isfinite(scan.min_range_m) || !(scan.min_range_m > 0.0)) scan.min_range_m = 0.0;
  return scan;
}

}  // namespace

bool is_read_as_scan(std::string_view type, std::string_view encoding) {
  return is_known_encoding(encoding) && kind_of_type(type) == Kind::kScan;
}

bool is_read_as_poses(std::string_view type, std::string_view encoding) {
  const auto kind = kind_of_type(type);
  return is_known_encoding(encoding) && kind && *kind != Kind::kScan;
}

bool holds_transforms(std::string_view type) {
  const auto kind = kind_of_type(type);
  return kind == Kind::kTransforms || kind == Kind::kTransform;
}

RosScan scan_in(const MessageView& message) {
  if (message.encoding == "json") return checked(scan_of_json(json_in(message.data)));
  return checked(scan_of_fields({message.data, message.encoding == "cdr"}));
}

std::vector<RosPose> poses_in(const MessageView& message) {
  const auto kind = kind_of_type(message.type).value_or(Kind::kOdometry);
  if (message.encoding == "json") return poses_of_json(json_in(message.data), kind);
  return poses_of_fields({message.data, message.encoding == "cdr"}, kind);
}

}  // namespace deltamap::tool
