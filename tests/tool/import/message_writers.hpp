// SPDX-License-Identifier: Apache-2.0
// Small bags and MCAP files, and ROS messages in bytes, as other programs write them.
#pragma once

#include <bzlib.h>
#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/geometry/pose2.hpp"

namespace deltamap::tool {

template <typename Number>
std::string le(Number value) {
  return {reinterpret_cast<const char*>(&value), sizeof value};
}
inline std::string with_length(std::string_view text) {
  return le(static_cast<std::uint32_t>(text.size())) + std::string(text);
}

/// ROS 1's bytes, or CDR with its head and its padding; `kind` in its head: 1, or 7 or 17 of XCDR2.
class RosBytes {
 public:
  explicit RosBytes(bool is_cdr, char kind = 1) : is_cdr_{is_cdr}, kind_{kind} {}
  template <typename Number>
  RosBytes& add(Number value) {
    const std::size_t aligned = kind_ == 1 ? sizeof value : std::min<std::size_t>(4, sizeof value);
    if (is_cdr_) bytes_.resize((bytes_.size() + aligned - 1) / aligned * aligned, '\0');
    bytes_ += le(value);
    return *this;
  }
  RosBytes& text(const std::string& value) {
    add(static_cast<std::uint32_t>(value.size() + (is_cdr_ ? 1 : 0)));
    bytes_ += value;
    if (is_cdr_) bytes_ += '\0';
    return *this;
  }
  RosBytes& header(double time_s, const std::string& frame) {
    if (!is_cdr_) add(std::uint32_t{7});  // seq
    const double whole_s = std::floor(time_s);
    add(static_cast<std::uint32_t>(whole_s)).add(static_cast<std::uint32_t>(std::lround(1e9 * (time_s - whole_s))));
    return text(frame);
  }
  RosBytes& pose(double x, double y, double theta) {
    for (const double value : {x, y, 0.0, 0.0, 0.0, std::sin(0.5 * theta), std::cos(0.5 * theta)}) add(value);
    return *this;
  }
  [[nodiscard]] std::string bytes() const {
    return (is_cdr_ ? std::string{'\0', kind_, '\0', '\0'} : std::string{}) + bytes_;
  }

 private:
  bool is_cdr_;
  char kind_;
  std::string bytes_;
};

struct TestScan {
  double time_s = 0.0;
  double first_rad = -1.5707963;
  double step_rad = 0.017453293;
  double max_range_m = 30.0;
  std::vector<float> ranges_m;
};
inline std::string scan_bytes(const TestScan& scan, bool is_cdr) {
  RosBytes out{is_cdr};
  out.header(scan.time_s, "laser");
  const double last_rad = scan.first_rad + scan.step_rad * static_cast<double>(scan.ranges_m.size() - 1);
  for (const double value : {scan.first_rad, last_rad, scan.step_rad, 0.0, 0.0, 0.05, scan.max_range_m})
    out.add(static_cast<float>(value));
  out.add(static_cast<std::uint32_t>(scan.ranges_m.size()));
  for (const float range_m : scan.ranges_m) out.add(range_m);
  return out.add(std::uint32_t{0}).bytes();  // intensities
}
inline std::string odometry_bytes(double time_s, double x, double theta, bool is_cdr, char kind = 1) {
  RosBytes out{is_cdr, kind};
  out.header(time_s, "odom").text("base_link").pose(x, 0.0, theta);
  for (int i = 0; i < 36 + 6 + 36; ++i) out.add(0.0);
  return out.bytes();
}
inline std::string transform_bytes(double time_s, const std::string& frame, const std::string& child, double x,
                                   double y, double theta) {
  RosBytes out{false};
  return out.add(std::uint32_t{1}).header(time_s, frame).text(child).pose(x, y, theta).bytes();
}
/// As XCDR2; `sized`: with the size of the list before it.
inline std::string xcdr2_transform_bytes(double time_s, const std::string& frame, const std::string& child,
                                         const Pose2& pose, bool sized) {
  constexpr std::size_t kHeadBytes = 4;
  std::string bytes = RosBytes{true, 7}
                          .add(std::uint32_t{1})
                          .header(time_s, frame)
                          .text(child)
                          .pose(pose.x, pose.y, pose.theta)
                          .bytes();
  if (sized) bytes.insert(kHeadBytes, le(static_cast<std::uint32_t>(bytes.size() - kHeadBytes)));
  return bytes;
}
/// The child's z axis points down.
inline std::string hanging_bytes(double time_s, const std::string& frame, const std::string& child, double x, double y,
                                 double theta) {
  RosBytes out{false};
  out.add(std::uint32_t{1}).header(time_s, frame).text(child);
  for (const double value : {x, y, 0.0, std::cos(0.5 * theta), std::sin(0.5 * theta), 0.0, 0.0}) out.add(value);
  return out.bytes();
}

struct TestMessage {
  std::string topic;
  std::string type;
  double time_s = 0.0;
  std::string bytes;
};

inline std::string packed(const std::string& method, const std::string& bytes) {
  std::string out(2 * bytes.size() + 1000, '\0');
  if (method == "bz2") {
    auto size = static_cast<unsigned>(out.size());
    ::BZ2_bzBuffToBuffCompress(out.data(), &size, const_cast<char*>(bytes.data()), static_cast<unsigned>(bytes.size()),
                               9, 0, 0);
    out.resize(size);
  } else if (method == "lz4") {
    out.resize(::LZ4F_compressFrame(out.data(), out.size(), bytes.data(), bytes.size(), nullptr));
  } else if (method == "zstd") {
    out.resize(::ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), 3));
  } else {
    return bytes;
  }
  return out;
}

inline std::string bag_record(const std::vector<std::string>& fields, const std::string& data) {
  std::string header;
  for (const std::string& field : fields) header += with_length(field);
  return with_length(header) + with_length(data);
}
/// A chunk a message; `method`: none, bz2, lz4.
inline std::string bag_of(const std::vector<TestMessage>& messages, const std::string& method) {
  std::string bag =
      "#ROSBAG V2.0\n" + bag_record({"op=\x03", "index_pos=" + le(std::uint64_t{0}),
                                     "conn_count=" + le(std::uint32_t{1}), "chunk_count=" + le(std::uint32_t{0})},
                                    std::string(100, ' '));
  std::vector<std::string> topics;
  for (const TestMessage& message : messages) {
    std::uint32_t connection = 0;
    while (connection < topics.size() && topics[connection] != message.topic) ++connection;
    std::string chunk;
    if (connection == topics.size()) {
      topics.push_back(message.topic);
      chunk += bag_record({"op=\x07", "conn=" + le(connection), "topic=" + message.topic},
                          with_length("topic=" + message.topic) + with_length("type=" + message.type));
    }
    const auto sec = static_cast<std::uint32_t>(message.time_s);
    chunk += bag_record({"op=\x02", "conn=" + le(connection), "time=" + le(sec) + le(std::uint32_t{0})}, message.bytes);
    bag += bag_record({"op=\x05", "compression=" + method, "size=" + le(static_cast<std::uint32_t>(chunk.size()))},
                      packed(method, chunk));
    bag += bag_record(
        {"op=\x04", "ver=" + le(std::uint32_t{1}), "conn=" + le(connection), "count=" + le(std::uint32_t{1})},
        std::string(12, '\0'));
  }
  return bag;
}

inline std::string mcap_record(std::uint8_t opcode, const std::string& content) {
  return le(opcode) + le(static_cast<std::uint64_t>(content.size())) + content;
}
/// A chunk a message; `method`: "", lz4, zstd.
inline std::string mcap_of(const std::vector<TestMessage>& messages, const std::string& encoding,
                           const std::string& method) {
  const std::string magic{"\x89MCAP0\r\n", 8};
  std::string file = magic + mcap_record(0x01, with_length("") + with_length("test"));
  std::vector<std::string> topics;
  for (const TestMessage& message : messages) {
    std::uint16_t channel = 0;
    while (channel < topics.size() && topics[channel] != message.topic) ++channel;
    std::string chunk;
    if (channel == topics.size()) {
      topics.push_back(message.topic);
      const auto schema = static_cast<std::uint16_t>(channel + 1);
      chunk += mcap_record(0x03, le(schema) + with_length(message.type) + with_length("") + with_length(""));
      chunk += mcap_record(
          0x04, le(channel) + le(schema) + with_length(message.topic) + with_length(encoding) + with_length(""));
    }
    const auto ns = static_cast<std::uint64_t>(1e9 * message.time_s);
    chunk += mcap_record(0x05, le(channel) + le(std::uint32_t{0}) + le(ns) + le(ns) + message.bytes);
    const std::string small = packed(method, chunk);
    file += mcap_record(0x06, le(ns) + le(ns) + le(static_cast<std::uint64_t>(chunk.size())) + le(std::uint32_t{0}) +
                                  with_length(method) + le(static_cast<std::uint64_t>(small.size())) + small);
  }
  return file + mcap_record(0x0F, le(std::uint32_t{0})) + mcap_record(0x02, std::string(20, '\0')) + magic;
}

}  // namespace deltamap::tool
