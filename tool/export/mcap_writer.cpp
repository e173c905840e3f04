// SPDX-License-Identifier: Apache-2.0
#include "tool/export/mcap_writer.hpp"

#include <algorithm>
#include <stdexcept>

namespace deltamap::tool {
namespace {

constexpr std::string_view kMcapMagic{"\x89MCAP0\r\n", 8};
constexpr std::size_t kChunkBytes = 1'000'000;

// Opcodes of the records.
constexpr std::uint8_t kHeader = 0x01;
constexpr std::uint8_t kFooter = 0x02;
constexpr std::uint8_t kSchema = 0x03;
constexpr std::uint8_t kChannel = 0x04;
constexpr std::uint8_t kMessage = 0x05;
constexpr std::uint8_t kChunk = 0x06;
constexpr std::uint8_t kMessageIndex = 0x07;
constexpr std::uint8_t kChunkIndex = 0x08;
constexpr std::uint8_t kStatistics = 0x0B;
constexpr std::uint8_t kDataEnd = 0x0F;

/// Little-endian fields, one behind the other.
class McapFields {
 public:
  template <typename Number>
  McapFields& number(Number value) {
    for (std::size_t i = 0; i < sizeof value; ++i) {
      bytes_ += static_cast<char>(static_cast<std::uint64_t>(value) >> (8 * i) & 0xFF);
    }
    return *this;
  }
  /// With its length before it.
  McapFields& text(std::string_view value) {
    number(static_cast<std::uint32_t>(value.size()));
    bytes_ += value;
    return *this;
  }
  McapFields& raw(std::string_view value) {
    bytes_ += value;
    return *this;
  }
  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

std::string record(std::uint8_t opcode, const McapFields& content) {
  return McapFields{}
      .number(opcode)
      .number(static_cast<std::uint64_t>(content.bytes().size()))
      .raw(content.bytes())
      .bytes();
}

}  // namespace

void McapWriter::Span::add(std::uint64_t time) {
  first = is_empty ? time : std::min(first, time);
  last = is_empty ? time : std::max(last, time);
  is_empty = false;
}

McapWriter::McapWriter(std::filesystem::path file) : file_{std::move(file)}, out_{file_, std::ios::binary} {
  put(std::string(kMcapMagic));
  put(record(kHeader, McapFields{}.text("").text("deltamap")));
}

void McapWriter::put(const std::string& bytes) {
  if (!out_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()))) {
    throw std::runtime_error(file_.string() + ": cannot be written");
  }
  position_ += bytes.size();
}

McapWriter::Channel McapWriter::add_channel(const std::string& topic, const std::string& schema_name,
                                            const std::string& json_schema) {
  auto [schema, is_new] = schemas_.try_emplace(schema_name);
  if (is_new) {
    const auto number = static_cast<std::uint16_t>(schemas_.size());  // 0 means none
    schema->second = {
        number, record(kSchema, McapFields{}.number(number).text(schema_name).text("jsonschema").text(json_schema))};
  }
  const auto number = static_cast<Channel>(channels_.size());
  const McapFields fields = McapFields{}.number(number).number(schema->second.first).text(topic).text("json").text("");
  channels_.push_back({schema->second.second + record(kChannel, fields), 0, 0, {}, false});
  return number;
}

void McapWriter::write(Channel channel, Timestamp time, std::string_view json) {
  ChannelState& state = channels_.at(channel);
  if (!state.is_described) chunk_ += state.record;
  state.is_described = true;
  const auto stamp = static_cast<std::uint64_t>(std::max<std::int64_t>(0, unix_ns(time)));
  state.in_chunk.emplace_back(stamp, chunk_.size());
  chunk_ +=
      record(kMessage, McapFields{}.number(channel).number(state.sequence++).number(stamp).number(stamp).raw(json));
  chunk_span_.add(stamp);
  span_.add(stamp);
  ++state.messages;
  ++messages_;
  if (chunk_.size() > kChunkBytes) end_chunk();
}

void McapWriter::end_chunk() {
  if (chunk_.empty()) return;
  const std::uint64_t begin = position_;
  const auto size = static_cast<std::uint64_t>(chunk_.size());
  put(record(kChunk, McapFields{}
                         .number(chunk_span_.first)
                         .number(chunk_span_.last)
                         .number(size)
                         .number(std::uint32_t{0})  // no checksum
                         .text("")                  // no compression
                         .number(size)
                         .raw(chunk_)));
  const std::uint64_t chunk_length = position_ - begin;
  McapFields offsets;
  for (Channel channel = 0; channel < channels_.size(); ++channel) {
    auto& in_chunk = channels_[channel].in_chunk;
    if (in_chunk.empty()) continue;
    offsets.number(channel).number(position_);
    std::stable_sort(in_chunk.begin(), in_chunk.end());
    McapFields entries;
    for (const auto& [time, offset] : in_chunk) entries.number(time).number(offset);
    put(record(kMessageIndex, McapFields{}.number(channel).text(entries.bytes())));
    in_chunk.clear();
  }
  chunk_indices_.push_back(record(kChunkIndex, McapFields{}
                                                   .number(chunk_span_.first)
                                                   .number(chunk_span_.last)
                                                   .number(begin)
                                                   .number(chunk_length)
                                                   .text(offsets.bytes())
                                                   .number(position_ - begin - chunk_length)
                                                   .text("")
                                                   .number(size)
                                                   .number(size)));
  chunk_.clear();
  chunk_span_ = {};
}

std::string McapWriter::statistics() const {
  McapFields counts;
  for (Channel channel = 0; channel < channels_.size(); ++channel) {
    counts.number(channel).number(channels_[channel].messages);
  }
  return record(kStatistics, McapFields{}
                                 .number(messages_)
                                 .number(static_cast<std::uint16_t>(schemas_.size()))
                                 .number(static_cast<std::uint32_t>(channels_.size()))
                                 .number(std::uint32_t{0})  // attachments
                                 .number(std::uint32_t{0})  // metadata
                                 .number(static_cast<std::uint32_t>(chunk_indices_.size()))
                                 .number(span_.first)
                                 .number(span_.last)
                                 .text(counts.bytes()));
}

void McapWriter::close() {
  end_chunk();
  put(record(kDataEnd, McapFields{}.number(std::uint32_t{0})));
  const std::uint64_t summary = position_;
  for (const ChannelState& channel : channels_) put(channel.record);
  put(statistics());
  for (const std::string& index : chunk_indices_) put(index);
  put(record(kFooter, McapFields{}.number(summary).number(std::uint64_t{0}).number(std::uint32_t{0})));
  put(std::string(kMcapMagic));
  out_.close();
  if (!out_) throw std::runtime_error(file_.string() + ": cannot be written");
}

}  // namespace deltamap::tool
