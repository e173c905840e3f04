// SPDX-License-Identifier: Apache-2.0
#include "drivers/line_diagnosis.hpp"

#include "drivers/checksums.hpp"

namespace deltamap::drivers {
namespace {

unsigned word(std::span<const std::uint8_t> bytes, std::size_t low, std::size_t high) {
  return bytes[low] | static_cast<unsigned>(bytes[high]) << 8;
}

}  // namespace

void LineDiagnosis::hear(std::span<const std::uint8_t> bytes) {
  if (bytes.empty() || is_swapped_) return;
  heard_any_ = true;
  recent_.insert(recent_.end(), bytes.begin(), bytes.end());
  std::size_t begin = 0;
  while (begin < recent_.size()) {
    const Frame frame = other_frame_at(begin);
    if (frame == Frame::kWhole) is_swapped_ = true;
    if (frame != Frame::kNone) break;
    ++begin;
  }
  recent_.erase(recent_.begin(), recent_.begin() + static_cast<std::ptrdiff_t>(begin));
}

void LineDiagnosis::reset() {
  recent_.clear();
  heard_any_ = false;
  heard_own_ = false;
  is_swapped_ = false;
}

LineDiagnosis::Frame LineDiagnosis::other_frame_at(std::size_t begin) const {
  const auto bytes = std::span{recent_}.subspan(begin);
  const bool is_laser = expected_ == Device::kRobot;
  const std::uint8_t header[] = {static_cast<std::uint8_t>(is_laser ? 0x02 : 0xFA),
                                 static_cast<std::uint8_t>(is_laser ? 0x80 : 0xFB)};
  if (bytes[0] != header[0] || (bytes.size() > 1 && bytes[1] != header[1])) return Frame::kNone;
  const std::size_t length_end = is_laser ? 4 : 3;  // A1, B1
  if (bytes.size() < length_end) return Frame::kMayFollow;
  constexpr std::size_t kLongestTelegram = 808;
  const std::size_t length = is_laser ? word(bytes, 2, 3) : bytes[2];
  const bool is_possible = is_laser ? length >= 2 && length <= kLongestTelegram : length >= 3;
  if (!is_possible) return Frame::kNone;
  const std::size_t size = length_end + length + (is_laser ? 2 : 0);
  if (bytes.size() < size) return Frame::kMayFollow;
  const auto checked = bytes.first(size - 2);
  const bool is_right = is_laser ? lms200_crc(checked) == word(bytes, size - 2, size - 1)
                                 : pioneer_checksum(checked.subspan(length_end)) == word(bytes, size - 1, size - 2);
  return is_right ? Frame::kWhole : Frame::kNone;
}

std::string LineDiagnosis::phrase() const {
  if (is_swapped_) {
    return expected_ == Device::kRobot ? "the ports are swapped: the laser speaks on the robot's port"
                                       : "the ports are swapped: the robot speaks on the laser's port";
  }
  if (heard_own_) return "it was heard, but does not do what it is asked";
  return heard_any_ ? "garbage came: another device, or a bad cable" : "no bytes came: switched off, or not connected";
}

std::vector<std::uint8_t> LineDiagnosis::question_to_a_laser() {
  std::vector<std::uint8_t> request{0x02, 0x00, 0x01, 0x00, 0x3A};
  const unsigned crc = lms200_crc(request);
  request.push_back(static_cast<std::uint8_t>(crc & 0xFF));
  request.push_back(static_cast<std::uint8_t>(crc >> 8));
  return request;
}

}  // namespace deltamap::drivers
