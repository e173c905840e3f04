// SPDX-License-Identifier: Apache-2.0
// A session on a port that fails: what the operator reads, and who is told.
#include "daemon/stages/device_link.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace deltamap::daemon {
namespace {

namespace port = drivers::port;

struct FakeOutput {
  drivers::SessionOutput output;
};

/// Fails where it is told to by a byte.
class FakeSession {
 public:
  FakeOutput start(Timestamp) { return {}; }
  FakeOutput on_bytes(std::span<const std::uint8_t>, Timestamp) {
    FakeOutput out;
    out.output.log.push_back("robot has news");
    out.output.log.push_back("it went away");
    out.output.warnings.push_back("robot is somebody else's");
    out.output.failed = "robot has been silent";
    return out;
  }
  FakeOutput on_time(Timestamp now) { return farewell(now); }
  FakeOutput close(Timestamp now) {
    words_left_ = 3;
    return farewell(now);
  }
  void on_baud(unsigned) {}
  [[nodiscard]] unsigned baud() const { return 9600; }
  [[nodiscard]] std::size_t awaited_bytes() const { return 0; }

 private:
  /// A word at a time.
  FakeOutput farewell(Timestamp now) {
    FakeOutput out;
    if (words_left_ == 0) return out;
    out.output.requests.push_back({drivers::PortRequest::Kind::kWrite, {static_cast<std::uint8_t>(words_left_)}, 0});
    if (--words_left_ > 0) out.output.wake_at = now + std::chrono::milliseconds{5};
    return out;
  }
  int words_left_ = 0;
};

class FakePort final : public port::BytePort {
 public:
  FakePort(port::PortHandlers& handlers, std::vector<std::uint8_t>& written) : handlers_{handlers}, written_{written} {}
  void start(port::PortHandlers handlers) override { handlers_ = std::move(handlers); }
  void write(std::span<const std::uint8_t> bytes) override {
    written_.insert(written_.end(), bytes.begin(), bytes.end());
  }
  void set_baud(unsigned) override {}
  void discard_input() override {}
  void await(std::size_t) override {}
  [[nodiscard]] const std::string& name() const override { return name_; }
  [[nodiscard]] unsigned baud() const override { return 9600; }

 private:
  port::PortHandlers& handlers_;
  std::vector<std::uint8_t>& written_;
  std::string name_ = "/dev/robot";
};

class DeviceLinkTest : public testing::Test {
 protected:
  port::SerialPortAnswer opened() {
    if (!refused_.empty()) return {nullptr, refused_};
    return {std::make_unique<FakePort>(device_, written_), "", note_};
  }

  std::string refused_;
  std::string note_;
  std::vector<std::string> answered_;
  std::vector<std::string> log_;
  std::vector<std::string> warnings_;
  int lost_ = 0;
  std::string why_lost_;
  port::PortHandlers device_;
  std::vector<std::uint8_t> written_;
  boost::asio::io_context loop_;
  DeviceLink<FakeSession, FakeOutput> link_{
      loop_,
      port::PortId::kRobot,
      FakeSession{},
      {[this](boost::asio::io_context&, port::PortId, unsigned) { return opened(); }, [](port::ByteRecord&&) {},
       [](FakeOutput&) {},
       [this](const std::string& why) {
         ++lost_;
         why_lost_ = why;
       },
       [this](const std::string& line) { log_.push_back(line); },
       [this](const std::string& line) { warnings_.push_back(line); },
       [this](const std::string& name) { answered_.push_back(name); }}};
};

TEST_F(DeviceLinkTest, TellsThatTheDeviceIsLostWhenItsPortHangsUp) {
  link_.open();
  EXPECT_EQ(lost_, 0);
  device_.on_closed("the device hung up");
  EXPECT_EQ(lost_, 1);
  EXPECT_FALSE(link_.is_open());
  EXPECT_EQ(warnings_, std::vector<std::string>{"robot: /dev/robot: the device hung up; trying again"});
}

TEST_F(DeviceLinkTest, TellsThatTheDeviceIsLostWhenItCannotBeOpened) {
  refused_ = "/dev/robot is missing";
  link_.open();
  EXPECT_EQ(lost_, 1);
  EXPECT_EQ(why_lost_, "/dev/robot is missing");
  EXPECT_EQ(warnings_, std::vector<std::string>{"robot: /dev/robot is missing; trying again"});
}

TEST_F(DeviceLinkTest, TellsOnceThatItsPortIsAnotherOneAndBehindWhichTheDeviceAnswers) {
  note_ = "its adapter is /dev/robot now";
  for (int i = 0; i < 3; ++i) {
    link_.open();
    EXPECT_EQ(log_, std::vector<std::string>{"robot: its adapter is /dev/robot now"});
    device_.on_closed("the device hung up");
  }
  link_.tell_connected();
  EXPECT_TRUE(answered_.empty()) << "its port is gone again";
  link_.open();
  link_.tell_connected();
  EXPECT_EQ(answered_, std::vector<std::string>{"/dev/robot"});
}

TEST_F(DeviceLinkTest, NamesTheDeviceOnceInEveryLine) {
  link_.open();
  device_.on_bytes({}, Timestamp{});
  EXPECT_EQ(log_, (std::vector<std::string>{"robot has news", "robot: it went away"}));
  EXPECT_EQ(warnings_, (std::vector<std::string>{"robot is somebody else's", "robot has been silent; trying again"}));
}

TEST_F(DeviceLinkTest, AFarewellThatTakesItsTimeIsSentToItsEndAndNothingAfterIt) {
  link_.open();
  link_.close();
  EXPECT_EQ(written_, (std::vector<std::uint8_t>{3}));
  device_.on_bytes({}, Timestamp{});  // not heard any more
  loop_.run();
  EXPECT_EQ(written_, (std::vector<std::uint8_t>{3, 2, 1}));
  EXPECT_EQ(lost_, 0);
}

TEST_F(DeviceLinkTest, NothingThatIsAskedOfTheSessionMeanwhileCutsTheFarewellOff) {
  link_.open();
  link_.close();
  link_.handle({});  // `ctl drive`
  loop_.run_one();
  link_.handle(link_.session().on_time(Timestamp{}));  // takes a word out of turn
  loop_.run();
  EXPECT_EQ(written_, (std::vector<std::uint8_t>{3, 2, 1}));
}

TEST_F(DeviceLinkTest, APortThatHangsUpAfterItsSessionHasFailedIsNoSecondFailure) {
  link_.open();
  device_.on_bytes({}, Timestamp{});
  ASSERT_EQ(lost_, 1);
  device_.on_closed("the device hung up");
  EXPECT_EQ(lost_, 1);
}

}  // namespace
}  // namespace deltamap::daemon
