// SPDX-License-Identifier: Apache-2.0
// MCAP (https://mcap.dev/spec): records of an opcode, a length and content; messages lie in chunks or beside them.
// Indices and summary are passed over: what they lead to comes in order, too, and a file that was cut has none.
#include <algorithm>
#include <stdexcept>

#include "tool/import/byte_reader.hpp"
#include "tool/import/message_file.hpp"
#include "tool/import/unpacked.hpp"

namespace deltamap::tool {
namespace {

constexpr std::string_view kMcapHead{"\x89MCAP0\r\n", 8};
constexpr std::string_view kAnyMcap{"\x89MCAP", 5};

enum class McapOp : std::uint8_t {
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kDataEnd = 0x0F
};

class McapReader {
 public:
  explicit McapReader(const TakeMessage& take) : take_{take} {}

  MessageFile read(std::string_view bytes) {
    if (!bytes.starts_with(kMcapHead))
      throw std::runtime_error(bytes.starts_with(kAnyMcap) ? "MCAP of another version than 0" : "not an MCAP file");
    ByteReader reader{bytes};
    (void)reader.raw(kMcapHead.size());
    while (!is_over_) {
      const std::size_t at = reader.at();
      try {
        if (reader.is_at_end()) throw std::runtime_error("its end is missing");
        take_record(reader, false);
      } catch (const std::runtime_error& error) {
        file_.cut = cut_at(at, bytes.size(), error);
        break;
      }
    }
    return std::move(file_);
  }

 private:
  struct Channel {
    std::string topic;
    std::string type;
    std::string encoding;
  };

  void take_record(ByteReader& reader, bool is_in_chunk) {
    const auto op = static_cast<McapOp>(reader.number<std::uint8_t>());
    const auto length = reader.number<std::uint64_t>();
    if (length > reader.left()) throw OutOfBytes{};
    ByteReader content{reader.raw(length)};
    if (op == McapOp::kSchema) take_schema(content);
    if (op == McapOp::kChannel) take_channel(content);
    if (op == McapOp::kMessage) take_message(content);
    if (op == McapOp::kDataEnd || op == McapOp::kFooter) is_over_ = true;
    if (op == McapOp::kChunk && is_in_chunk) throw std::runtime_error("a chunk inside a chunk");
    if (op == McapOp::kChunk) take_chunk(content);
  }

  void take_chunk(ByteReader& content) {
    (void)content.raw(2 * sizeof(std::uint64_t));  // first and last time
    const auto size = content.number<std::uint64_t>();
    (void)content.number<std::uint32_t>();  // checksum: each method but none has its own
    const std::string_view method = content.text();
    const auto packed = content.number<std::uint64_t>();
    if (packed > content.left()) throw OutOfBytes{};
    const std::string chunk = unpacked(method, content.raw(packed), size);
    ByteReader records{chunk};
    while (!records.is_at_end()) take_record(records, true);
  }

  void take_schema(ByteReader& content) {
    const auto number = content.number<std::uint16_t>();
    schemas_[number] = content.text();
  }

  void take_channel(ByteReader& content) {
    const auto number = content.number<std::uint16_t>();
    const auto schema = schemas_.find(content.number<std::uint16_t>());
    Channel channel{std::string(content.text()), schema == schemas_.end() ? "" : schema->second,
                    std::string(content.text())};
    file_.topics.try_emplace(channel.topic, MessageFile::Topic{channel.type, channel.encoding, 0});
    channels_[number] = std::move(channel);
  }

  void take_message(ByteReader& content) {
    const auto found = channels_.find(content.number<std::uint16_t>());
    if (found == channels_.end()) throw std::runtime_error("a message of a channel that was not told");
    (void)content.number<std::uint32_t>();  // sequence
    constexpr std::uint64_t kLatest = INT64_MAX;
    const auto logged = static_cast<std::int64_t>(std::min(content.number<std::uint64_t>(), kLatest));
    (void)content.number<std::uint64_t>();  // published
    const Channel& channel = found->second;
    ++file_.topics.at(channel.topic).messages;
    take_({channel.topic, channel.type, channel.encoding, timestamp_from_ns(logged), content.raw(content.left())});
  }

  const TakeMessage& take_;
  std::map<std::uint16_t, std::string> schemas_;
  std::map<std::uint16_t, Channel> channels_;
  MessageFile file_;
  bool is_over_ = false;
};

}  // namespace

MessageFile read_mcap(std::string_view bytes, const TakeMessage& take) { return McapReader{take}.read(bytes); }

}  // namespace deltamap::tool
