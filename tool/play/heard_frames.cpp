// SPDX-License-Identifier: Apache-2.0
#include "tool/play/heard_frames.hpp"

#include <algorithm>
#include <cstdio>

#include "tool/decode/decoded_frame.hpp"
#include "tool/decode/frame_text.hpp"

namespace deltamap::tool {
namespace {

using drivers::port::Direction;

constexpr std::size_t kLookAhead = 20;  // frames that a client may have left out

/// "VEL 100"
std::string words_of(const DecodedFrame& frame) {
  for (const auto& [name, value] : frame.fields) {
    if (name == "argument" && std::holds_alternative<std::int64_t>(value)) {
      return frame.name + " " + std::to_string(std::get<std::int64_t>(value));
    }
    if (name == "meaning") return frame.name + " (" + std::get<std::string>(value) + ")";
  }
  return frame.name;
}

}  // namespace

FrameReader::Sinks HeardFrames::sinks_into(std::vector<Frame>& frames, std::uint64_t& garbage_bytes) const {
  return {[&frames](const drivers::pioneer::Packet& packet, const LineEnd& line) {
            if (line.direction == Direction::kOut) {
              frames.push_back({words_of(robot_frame(packet, line.direction)), packet.data});
            }
          },
          [&frames](const drivers::lms200::Telegram& telegram, const LineEnd& line) {
            if (line.direction == Direction::kIn) return;
            Frame frame{words_of(laser_frame(telegram, line.direction, std::nullopt)), telegram.data};
            frame.content.insert(frame.content.begin(), telegram.command);
            frames.push_back(std::move(frame));
          },
          [&garbage_bytes](const drivers::DecoderCounts& garbage, const LineEnd& line) {
            if (line.direction == Direction::kOut) garbage_bytes += garbage.garbage_bytes;
          }};
}

void HeardFrames::expect(const drivers::port::ByteRecord& record) {
  std::vector<Frame> frames;
  std::uint64_t ignored = 0;
  recorded_reader_.feed(record, sinks_into(frames, ignored));
  expected_.insert(expected_.end(), frames.begin(), frames.end());
}

/// Empty: it is the one that comes next.
std::string HeardFrames::judge(const Frame& frame) {
  const auto end = expected_.begin() + static_cast<std::ptrdiff_t>(std::min(kLookAhead, expected_.size()));
  const auto found =
      std::find_if(expected_.begin(), end, [&](const Frame& one) { return one.content == frame.content; });
  const std::size_t left_out = static_cast<std::size_t>(found - expected_.begin());
  if (found != end) {
    const std::string skipped = expected_.front().name;
    expected_.erase(expected_.begin(), found + 1);
    ++same_;
    if (left_out == 0) return {};
    return frame.name + "; left out before it: " + skipped +
           (left_out > 1 ? " and " + std::to_string(left_out - 1) + " more" : "");
  }
  if (expected_.empty()) return frame.name + "; nothing more was recorded";
  const auto kind = [](const std::string& name) { return name.substr(0, name.find(' ')); };
  if (kind(expected_.front().name) != kind(frame.name)) {
    return frame.name + "; not recorded here, where " + expected_.front().name + " comes next";
  }
  const std::string recorded = expected_.front().name;
  expected_.pop_front();
  return frame.name + " in place of " + recorded;
}

std::vector<std::string> HeardFrames::hear(const std::vector<std::uint8_t>& bytes, Timestamp now, unsigned baud,
                                           double after_s) {
  std::vector<Frame> frames;
  std::uint64_t garbage_bytes = 0;
  reader_.feed({port_, Direction::kOut, now, bytes, {}, baud}, sinks_into(frames, garbage_bytes));
  std::vector<std::string> lines;
  const auto tell = [&](const std::string& what) {
    char after[32];
    (void)std::snprintf(after, sizeof after, "after %.3f s ", after_s);
    lines.push_back(after + std::string(name_of(port_)) + " hears " + what);
    ++differences_;
  };
  if (garbage_bytes > 0) tell(std::to_string(garbage_bytes) + " bytes that are no frame");
  for (const Frame& frame : frames) {
    if (const std::string difference = judge(frame); !difference.empty()) tell(difference);
  }
  return lines;
}

}  // namespace deltamap::tool
