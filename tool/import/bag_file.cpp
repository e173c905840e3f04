// SPDX-License-Identifier: Apache-2.0
// Bags of ROS 1 (http://wiki.ros.org/Bags/Format/2.0): records of a header, which is fields NAME=VALUE, and data.
// Indices are passed over: what they lead to comes in order, too, and a bag that was cut has none.
#include <stdexcept>

#include "tool/import/byte_reader.hpp"
#include "tool/import/message_file.hpp"
#include "tool/import/unpacked.hpp"

namespace deltamap::tool {
namespace {

constexpr std::string_view kBagMagic = "#ROSBAG V2.0\n";
constexpr std::string_view kAnyBag = "#ROSBAG V";

enum class BagOp : std::uint8_t {
  kMessage = 0x02,
  kHeader = 0x03,
  kIndex = 0x04,
  kChunk = 0x05,
  kChunkInfo = 0x06,
  kConnection = 0x07
};

using BagFields = std::map<std::string_view, std::string_view>;

BagFields bag_fields_in(std::string_view header) {
  BagFields fields;
  ByteReader reader{header};
  while (!reader.is_at_end()) {
    const std::string_view field = reader.text();
    const std::size_t sign = field.find('=');
    if (sign == std::string_view::npos) throw std::runtime_error("a record's header has a field without a value");
    fields.emplace(field.substr(0, sign), field.substr(sign + 1));
  }
  return fields;
}

template <typename Number>
Number bag_number(const BagFields& fields, std::string_view name) {
  const auto found = fields.find(name);
  if (found == fields.end()) throw std::runtime_error("a record has no field \"" + std::string(name) + "\"");
  return ByteReader{found->second}.number<Number>();
}

std::string_view bag_text(const BagFields& fields, std::string_view name) {
  const auto found = fields.find(name);
  return found == fields.end() ? std::string_view{} : found->second;
}

class BagReader {
 public:
  explicit BagReader(const TakeMessage& take) : take_{take} {}

  MessageFile read(std::string_view bytes) {
    if (!bytes.starts_with(kBagMagic)) {
      throw std::runtime_error(bytes.starts_with(kAnyBag)
                                   ? "a bag of another format than 2.0: `rosbag migrate` makes it one"
                                   : "not a ROS 1 bag");
    }
    ByteReader reader{bytes};
    (void)reader.raw(kBagMagic.size());
    while (!reader.is_at_end()) {
      const std::size_t at = reader.at();
      try {
        take_record(reader, false);
      } catch (const std::runtime_error& error) {
        file_.cut = cut_at(at, bytes.size(), error);
        break;
      }
    }
    return std::move(file_);
  }

 private:
  struct Connection {
    std::string topic;
    std::string type;
  };

  void take_record(ByteReader& reader, bool is_in_chunk) {
    const BagFields fields = bag_fields_in(reader.text());
    const std::string_view data = reader.text();
    const auto op = static_cast<BagOp>(bag_number<std::uint8_t>(fields, "op"));
    if (op == BagOp::kConnection) take_connection(fields, data);
    if (op == BagOp::kMessage) take_message(fields, data);
    if (op != BagOp::kChunk) return;
    if (is_in_chunk) throw std::runtime_error("a chunk inside a chunk");
    const std::string chunk =
        unpacked(bag_text(fields, "compression"), data, bag_number<std::uint32_t>(fields, "size"));
    ByteReader records{chunk};
    while (!records.is_at_end()) take_record(records, true);
  }

  void take_connection(const BagFields& fields, std::string_view data) {
    const BagFields told = bag_fields_in(data);
    Connection connection{std::string(bag_text(fields, "topic")), std::string(bag_text(told, "type"))};
    file_.topics.try_emplace(connection.topic, MessageFile::Topic{connection.type, "ros1", 0});
    connections_[bag_number<std::uint32_t>(fields, "conn")] = std::move(connection);
  }

  void take_message(const BagFields& fields, std::string_view data) {
    const auto connection = connections_.find(bag_number<std::uint32_t>(fields, "conn"));
    if (connection == connections_.end()) throw std::runtime_error("a message of a connection that was not told");
    ByteReader time{bag_text(fields, "time")};
    const auto sec = time.number<std::uint32_t>();
    const auto nsec = time.number<std::uint32_t>();
    const auto& [topic, type] = connection->second;
    ++file_.topics.at(topic).messages;
    take_({topic, type, "ros1", timestamp_from_ns(std::int64_t{sec} * 1'000'000'000 + nsec), data});
  }

  const TakeMessage& take_;
  std::map<std::uint32_t, Connection> connections_;
  MessageFile file_;
};

}  // namespace

MessageFile read_bag(std::string_view bytes, const TakeMessage& take) { return BagReader{take}.read(bytes); }

}  // namespace deltamap::tool
