// SPDX-License-Identifier: Apache-2.0
#include "drivers/lms200/telegram.hpp"

#include <cassert>

#include "drivers/byte_fields.hpp"
#include "drivers/checksums.hpp"

namespace deltamap::drivers::lms200 {
namespace {

constexpr std::uint8_t kStx = 0x02;
constexpr std::uint8_t kDeviceAddress = 0x80;
constexpr std::size_t kHeaderSize = 4;                  // STX, address, length
constexpr Duration kPauseBetweenTelegrams{30'000'000};  // longer than the 14 ms that a device may pause inside one

std::vector<std::uint8_t> with_crc(const std::vector<std::uint8_t>& bytes) {
  return FieldWriter{}.bytes(bytes).u16(crc16(bytes)).written();
}

}  // namespace

std::uint16_t crc16(std::span<const std::uint8_t> bytes) { return lms200_crc(bytes); }

std::vector<std::uint8_t> encoded_request(std::uint8_t command, std::span<const std::uint8_t> data,
                                          std::uint8_t address) {
  const std::size_t length = data.size() + 1;
  assert(length <= kMaxLength && "a telegram has at most 808 bytes of content");
  FieldWriter frame;
  frame.u8(kStx).u8(address).u16(static_cast<unsigned>(length)).u8(command).bytes(data);
  return with_crc(frame.written());
}

std::vector<std::uint8_t> encoded_reply(std::uint8_t response, std::span<const std::uint8_t> data, std::uint8_t status,
                                        std::uint8_t address) {
  const std::size_t length = data.size() + 2;
  assert(length <= kMaxLength && "a telegram has at most 808 bytes of content");
  FieldWriter frame;
  frame.u8(kStx).u8(address).u16(static_cast<unsigned>(length)).u8(response).bytes(data).u8(status);
  return with_crc(frame.written());
}

void TelegramDecoder::set_baud(unsigned baud) {
  if (baud == baud_) return;
  if (!received_.bytes().empty()) ++counts_.truncated;
  received_.clear();
  baud_ = baud;
  in_garbage_ = false;
}

std::vector<Telegram> TelegramDecoder::decode(std::span<const std::uint8_t> bytes, Timestamp stamp) {
  std::vector<Telegram> telegrams;
  if (bytes.empty()) return telegrams;
  const Duration pause = stamp - received_.newest_stamp();
  if (!received_.bytes().empty() && pause > kLongestPauseInFrame) telegrams = finish();
  if (received_.bytes().empty() && pause > kPauseBetweenTelegrams) in_garbage_ = false;
  received_.append(bytes, stamp);
  take_telegrams(true, telegrams);
  return telegrams;
}

std::vector<Telegram> TelegramDecoder::finish() {
  std::vector<Telegram> telegrams;
  take_telegrams(false, telegrams);
  return telegrams;
}

TelegramDecoder::Header TelegramDecoder::header_at_front() const {
  const std::span<const std::uint8_t> bytes = received_.bytes();
  if (bytes[0] != kStx) return Header::kNo;
  if (bytes.size() < 2) return Header::kTooShortToTell;
  const bool is_address = sender_ == Sender::kDevice ? bytes[1] == kDeviceAddress : bytes[1] < kDeviceAddress;
  if (!is_address) return Header::kNo;
  return bytes.size() < kHeaderSize ? Header::kTooShortToTell : Header::kYes;
}

bool TelegramDecoder::is_acknowledgement_at_front() const {
  const std::uint8_t first = received_.bytes()[0];
  return sender_ == Sender::kDevice && !in_garbage_ && (first == kAckByte || first == kNakByte);
}

std::size_t TelegramDecoder::awaited_bytes() const {
  const std::span<const std::uint8_t> bytes = received_.bytes();
  if (bytes.size() < kHeaderSize || header_at_front() != Header::kYes) return 0;
  const std::size_t frame_size = length_at_front() + kFrameOverhead;
  return frame_size > bytes.size() ? frame_size - bytes.size() : 0;
}

std::size_t TelegramDecoder::length_at_front() const {
  const std::span<const std::uint8_t> bytes = received_.bytes();
  return bytes[2] | static_cast<std::size_t>(bytes[3]) << 8;
}

void TelegramDecoder::skip_byte() {
  ++counts_.garbage_bytes;
  in_garbage_ = true;
  received_.drop_front(1);
}

void TelegramDecoder::take_telegrams(bool more_may_come, std::vector<Telegram>& telegrams) {
  while (!received_.bytes().empty()) {
    if (is_acknowledgement_at_front()) {
      take_acknowledgement(telegrams);
      continue;
    }
    const Header header = header_at_front();
    if (header == Header::kNo) {
      skip_byte();
      continue;
    }
    const std::span<const std::uint8_t> bytes = received_.bytes();
    const bool has_length = header == Header::kYes;
    const std::size_t length = has_length ? length_at_front() : 0;
    const std::size_t min_length = sender_ == Sender::kDevice ? 2 : 1;
    if (has_length && (length < min_length || length > kMaxLength)) {
      ++counts_.bad_length;
      skip_byte();
      continue;
    }
    if (!has_length || bytes.size() < length + kFrameOverhead) {
      if (more_may_come) return;
      ++counts_.truncated;
      skip_byte();
      continue;
    }
    take_whole_telegram(length + kFrameOverhead, telegrams);
  }
}

void TelegramDecoder::take_acknowledgement(std::vector<Telegram>& telegrams) {
  Telegram telegram;
  telegram.kind = received_.bytes()[0] == kAckByte ? Telegram::Kind::kAck : Telegram::Kind::kNak;
  telegram.first_byte = received_.arrival_of_first(0, baud_);
  telegram.received = received_.stamp_of(0);
  telegrams.push_back(std::move(telegram));
  received_.drop_front(1);
}

void TelegramDecoder::take_whole_telegram(std::size_t frame_size, std::vector<Telegram>& telegrams) {
  const std::span<const std::uint8_t> frame = received_.bytes().first(frame_size);
  const std::span<const std::uint8_t> checked = frame.first(frame_size - 2);
  const unsigned sent = frame[frame_size - 2] | static_cast<unsigned>(frame[frame_size - 1]) << 8;
  if (crc16(checked) != sent) {
    ++counts_.bad_checksum;
    skip_byte();
    return;
  }
  std::span<const std::uint8_t> data = checked.subspan(kHeaderSize + 1);
  Telegram telegram;
  telegram.first_byte = received_.arrival_of_first(0, baud_);
  telegram.received = received_.stamp_of(frame_size - 1);
  telegram.address = frame[1];
  telegram.command = frame[kHeaderSize];
  if (sender_ == Sender::kDevice) {
    telegram.status = data.back();
    data = data.first(data.size() - 1);
  }
  telegram.data.assign(data.begin(), data.end());
  telegrams.push_back(std::move(telegram));
  ++counts_.frames;
  in_garbage_ = false;
  received_.drop_front(frame_size);
}

}  // namespace deltamap::drivers::lms200
