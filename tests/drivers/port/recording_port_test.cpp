// SPDX-License-Identifier: Apache-2.0
#include "drivers/port/recording_port.hpp"

#include <gtest/gtest.h>

#include <utility>

namespace deltamap::drivers::port {
namespace {

/// Writes down what is asked of it, and lets the test speak for the device.
class ScriptedPort final : public BytePort {
 public:
  explicit ScriptedPort(std::vector<std::string>& calls) : calls_{calls} {}
  void start(PortHandlers handlers) override { handlers_ = std::move(handlers); }
  void write(std::span<const std::uint8_t> bytes) override {
    calls_.push_back("write " + std::to_string(bytes.size()));
  }
  void set_baud(unsigned baud) override {
    baud_ = baud;
    calls_.push_back("baud " + std::to_string(baud));
  }
  void discard_input() override { calls_.push_back("discard"); }
  void await(std::size_t bytes) override { calls_.push_back("await " + std::to_string(bytes)); }
  [[nodiscard]] const std::string& name() const override { return name_; }
  [[nodiscard]] unsigned baud() const override { return baud_; }

  PortHandlers handlers_;

 private:
  std::vector<std::string>& calls_;
  std::string name_ = "scripted";
  unsigned baud_ = 9600;
};

TEST(RecordingPort, HandsOnEverythingAndTellsTheSinkInOrder) {
  std::vector<std::string> calls;
  std::vector<ByteRecord> records;
  auto scripted = std::make_unique<ScriptedPort>(calls);
  ScriptedPort& device = *scripted;
  const Timestamp now = timestamp_from_ns(42);
  RecordingPort port{std::move(scripted), PortId::kLaser,
                     [&](ByteRecord&& record) { records.push_back(std::move(record)); }, [&] { return now; }};
  std::vector<std::uint8_t> received;
  std::string closed;
  port.start({[&](std::span<const std::uint8_t> bytes, Timestamp) { received.assign(bytes.begin(), bytes.end()); },
              [&](const std::string& reason) { closed = reason; }});
  const std::vector<std::uint8_t> out{1, 2, 3};
  const std::vector<std::uint8_t> in{6};
  port.write(out);
  port.set_baud(38400);
  port.discard_input();
  port.await(7);
  device.handlers_.on_bytes(in, timestamp_from_ns(43));
  device.handlers_.on_closed("unplugged");

  EXPECT_EQ(calls, (std::vector<std::string>{"write 3", "baud 38400", "discard", "await 7"}));
  EXPECT_EQ(received, in);
  EXPECT_EQ(closed, "unplugged");
  EXPECT_EQ(port.name(), "scripted");
  ASSERT_EQ(records.size(), 4u);
  EXPECT_EQ(records[0].note, "baud 9600");
  EXPECT_EQ(records[1].bytes, out);
  EXPECT_EQ(records[1].direction, Direction::kOut);
  EXPECT_EQ(records[1].stamp, now);
  EXPECT_EQ(records[2].note, "baud 38400");
  EXPECT_EQ(records[3].bytes, in);
  EXPECT_EQ(records[3].direction, Direction::kIn);
  EXPECT_EQ(records[3].stamp, timestamp_from_ns(43));
  EXPECT_EQ(records[3].baud, 38400u);
  for (const auto& record : records) EXPECT_EQ(record.port, PortId::kLaser);
}

}  // namespace
}  // namespace deltamap::drivers::port
