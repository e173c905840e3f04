// SPDX-License-Identifier: Apache-2.0
// The serial port against the other end of a pseudo-terminal.
#include "drivers/port/serial_port.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/epoll.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <numeric>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "drivers/port/port_clock.hpp"
#include "tests/support/files/temporary_folder.hpp"

namespace deltamap::drivers::port {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// The device's end.
class PseudoTerminal {
 public:
  /// `is_watched`: for wait_until_carried().
  explicit PseudoTerminal(bool is_watched = false) : master_{::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK)} {
    (void)::grantpt(master_);
    (void)::unlockpt(master_);
    path_ = ::ptsname(master_);
    if (is_watched) other_end_ = ::open(path_.c_str(), O_RDONLY | O_NOCTTY | O_NONBLOCK);
  }
  ~PseudoTerminal() {
    hang_up();
    if (other_end_ >= 0) ::close(other_end_);
  }
  void hang_up() {
    if (master_ >= 0) ::close(master_);
    master_ = -1;
  }
  void send(const Bytes& bytes) const {
    ASSERT_EQ(::write(master_, bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
  }
  /// What was sent is carried to the other end by a thread of the kernel, in pieces and when it gets to it.
  void wait_until_carried(int bytes) const {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(120);
    for (int unread = 0; unread < bytes; std::this_thread::sleep_for(std::chrono::milliseconds(1))) {
      ASSERT_EQ(::ioctl(other_end_, FIONREAD, &unread), 0);
      ASSERT_LT(std::chrono::steady_clock::now(), deadline);
    }
  }
  [[nodiscard]] Bytes received() const {
    Bytes bytes(4096);
    const ssize_t count = ::read(master_, bytes.data(), bytes.size());
    bytes.resize(count > 0 ? static_cast<std::size_t>(count) : 0);
    return bytes;
  }
  [[nodiscard]] speed_t speed() const {
    termios line{};
    (void)::tcgetattr(master_, &line);
    return ::cfgetospeed(&line);
  }
  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  int master_;
  int other_end_ = -1;  // a second descriptor of the port's own end
  std::string path_;
};

void run_until(boost::asio::io_context& loop, const std::function<bool()>& done) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(120);
  while (!done()) {
    ASSERT_LT(std::chrono::steady_clock::now(), deadline);
    loop.restart();
    loop.run_one_for(std::chrono::milliseconds(20));
  }
}

TEST(SerialPort, CarriesEveryByteValueBothWaysUnchanged) {
  PseudoTerminal device;
  boost::asio::io_context loop;
  auto [port, refused, note] = open_serial_port(loop, device.path(), 9600);
  ASSERT_TRUE(port) << refused;
  Bytes all;
  for (int i = 0; i < 256; ++i) all.push_back(static_cast<std::uint8_t>(i));
  Bytes in;
  Timestamp stamp;
  const Timestamp before = port_clock_now();
  port->start({[&](std::span<const std::uint8_t> bytes, Timestamp at) {
                 in.insert(in.end(), bytes.begin(), bytes.end());
                 stamp = at;
               },
               {}});
  port->write(all);
  device.send(all);
  Bytes out;
  run_until(loop, [&] {
    const Bytes more = device.received();
    out.insert(out.end(), more.begin(), more.end());
    return in.size() >= all.size() && out.size() >= all.size();
  });
  EXPECT_EQ(in, all);
  EXPECT_EQ(out, all);
  EXPECT_GE(stamp, before);
  EXPECT_LE(stamp, port_clock_now());
}

/// A port that notes the size of each chunk; null where it cannot be opened.
auto started(boost::asio::io_context& loop, const PseudoTerminal& device, std::vector<std::size_t>& chunks) {
  auto [port, refused, note] = open_serial_port(loop, device.path(), 500000);
  EXPECT_TRUE(port) << refused;
  if (port) port->start({[&](std::span<const std::uint8_t> bytes, Timestamp) { chunks.push_back(bytes.size()); }, {}});
  return std::move(port);
}

TEST(SerialPort, HandsOverAsOneChunkWhatCameWhileTheLoopStoodStill) {
  PseudoTerminal device{true};
  boost::asio::io_context loop;
  std::vector<std::size_t> chunks;
  const auto port = started(loop, device, chunks);
  ASSERT_TRUE(port);
  constexpr std::size_t kScans = 15;
  for (std::size_t i = 0; i < kScans; ++i) device.send(Bytes(732, 0x02));  // more than a terminal gives at once
  device.wait_until_carried(4 * 732);
  run_until(loop, [&] { return !chunks.empty(); });
  EXPECT_EQ(chunks, std::vector<std::size_t>{kScans * 732});
}

TEST(SerialPort, HandsOverAsOneChunkWhatComesInPiecesBehindAStandstill) {
  PseudoTerminal device{true};
  boost::asio::io_context loop;
  std::vector<std::size_t> chunks;
  const auto port = started(loop, device, chunks);
  ASSERT_TRUE(port);
  for (int piece = 0; piece < 3; ++piece) {
    device.send(Bytes(2048, 0x02));
    device.wait_until_carried(2048);
    loop.restart();
    EXPECT_EQ(loop.run_one(), 1u);
  }
  EXPECT_TRUE(chunks.empty()) << "there may be more";
  run_until(loop, [&] { return !chunks.empty(); });
  EXPECT_EQ(chunks, std::vector<std::size_t>{3 * 2048});
  device.send({1, 2, 3});  // in time: at once
  loop.restart();
  EXPECT_EQ(loop.run_one(), 1u);
  EXPECT_EQ(chunks.size(), 2u);
}

/// Awaits so many bytes after each chunk, and answers the chunks that three pieces of a frame come in.
std::vector<std::size_t> chunks_of_a_frame(std::size_t awaited, const std::function<void(BytePort&)>& meanwhile = {}) {
  PseudoTerminal device;
  boost::asio::io_context loop;
  std::vector<std::size_t> chunks;
  auto [port, refused, note] = open_serial_port(loop, device.path(), 9600);
  EXPECT_TRUE(port) << refused;
  if (!port) return {};
  port->start({[&, to = port.get()](std::span<const std::uint8_t> bytes, Timestamp) {
                 chunks.push_back(bytes.size());
                 to->await(awaited);
               },
               {}});
  for (int piece = 0; piece < 3; ++piece) {
    device.send(Bytes(20, 0x02));
    loop.restart();
    loop.run_one();
    if (meanwhile) meanwhile(*port);
  }
  run_until(loop, [&] { return std::accumulate(chunks.begin(), chunks.end(), std::size_t{0}) == 60; });
  return chunks;
}

TEST(SerialPort, LooksForBytesThatAreOfNoUseYetWhenAllMustHaveCome) {
  EXPECT_EQ(chunks_of_a_frame(0), (std::vector<std::size_t>{20, 20, 20}));
  const std::vector<std::size_t> rested = chunks_of_a_frame(80);
  EXPECT_LE(rested.size(), 3u);
  EXPECT_EQ(rested.front(), 20u) << "the first piece is stamped as it comes";
}

TEST(SerialPort, RestsNoLongerWhereTheBaudChangesOrInputIsDiscarded) {
  PseudoTerminal device;
  boost::asio::io_context loop;
  std::size_t count = 0;
  auto [port, refused, note] = open_serial_port(loop, device.path(), 9600);
  ASSERT_TRUE(port) << refused;
  port->start({[&, to = port.get()](std::span<const std::uint8_t> bytes, Timestamp) {
                 count += bytes.size();
                 to->await(800);
               },
               {}});
  const std::vector<std::function<void(BytePort&)>> ends_of_rest{[](BytePort& of) { of.set_baud(38400); },
                                                                 [](BytePort& of) { of.discard_input(); }};
  for (const auto& end_rest : ends_of_rest) {
    auto soonest = std::chrono::steady_clock::duration::max();  // another program may have the processor
    for (int attempt = 0; attempt < 5; ++attempt) {
      device.send(Bytes(4, 0x02));
      const std::size_t before = count;
      run_until(loop, [&] { return count > before; });
      const auto began = std::chrono::steady_clock::now();
      end_rest(*port);
      device.send({0x06});
      run_until(loop, [&] { return count == before + 5; });
      soonest = std::min(soonest, std::chrono::steady_clock::now() - began);
    }
    EXPECT_LT(soonest, std::chrono::milliseconds(80));
  }
}

/// This process's descriptor of such a file; -1: none.
int descriptor_of(const std::string& file) {
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd")) {
    std::error_code error;
    if (std::filesystem::read_symlink(entry.path(), error) == file) return std::stoi(entry.path().filename());
  }
  return -1;
}

TEST(SerialPort, TellsOnceWhenTheLoopCannotHearOfItAgainBehindARest) {
  PseudoTerminal device;
  boost::asio::io_context loop;
  auto [port, refused, note] = open_serial_port(loop, device.path(), 9600);
  ASSERT_TRUE(port) << refused;
  std::size_t count = 0;
  std::vector<std::string> reasons;
  port->start({[&, to = port.get()](std::span<const std::uint8_t> bytes, Timestamp) {
                 count += bytes.size();
                 if (count == 4) to->await(80);
               },
               [&](const std::string& reason) { reasons.push_back(reason); }});
  device.send(Bytes(4, 0x02));
  run_until(loop, [&] { return count == 4; });
  // While it rests somebody else makes the loop listen to its terminal: that is refused a second time.
  const int poll = descriptor_of("anon_inode:[eventpoll]");
  const int terminal = descriptor_of(device.path());
  epoll_event nothing{};
  ASSERT_EQ(::epoll_ctl(poll, EPOLL_CTL_ADD, terminal, &nothing), 0) << "it rests: the loop does not hear of it";
  device.send({0x06});
  run_until(loop, [&] { return !reasons.empty(); });
  EXPECT_EQ(count, 5u) << "what came meanwhile is handed over";
  loop.restart();
  loop.run_for(std::chrono::milliseconds(20));
  EXPECT_EQ(reasons, std::vector<std::string>{"the device cannot be listened to (File exists)"});
}

TEST(SerialPort, ChangesTheBaudAfterTheBytesBeforeAndBeforeTheBytesAfter) {
  PseudoTerminal device;
  boost::asio::io_context loop;
  auto [port, refused, note] = open_serial_port(loop, device.path(), 9600);
  ASSERT_TRUE(port) << refused;
  EXPECT_EQ(device.speed(), static_cast<speed_t>(B9600));
  port->start({});
  port->write(Bytes{1, 2});
  port->set_baud(500000);
  port->write(Bytes{3});
  EXPECT_EQ(device.received(), (Bytes{1, 2}));  // the third byte waits until the first two have had time to leave
  EXPECT_EQ(device.speed(), static_cast<speed_t>(B9600));
  EXPECT_EQ(port->baud(), 500000u);
  Bytes out;
  run_until(loop, [&] {
    out = device.received();
    return !out.empty();
  });
  EXPECT_EQ(out, (Bytes{3}));
  EXPECT_EQ(device.speed(), static_cast<speed_t>(B500000));
}

TEST(SerialPort, WritesMoreThanTheKernelTakesAtOnce) {
  PseudoTerminal device;
  boost::asio::io_context loop;
  auto [port, refused, note] = open_serial_port(loop, device.path(), 500000);
  ASSERT_TRUE(port) << refused;
  Bytes much(100'000);
  for (std::size_t i = 0; i < much.size(); ++i) much[i] = static_cast<std::uint8_t>(i * 7);
  port->start({});
  port->write(much);
  Bytes out;
  run_until(loop, [&] {
    const Bytes more = device.received();
    out.insert(out.end(), more.begin(), more.end());
    return out.size() >= much.size();
  });
  EXPECT_EQ(out, much);
}

TEST(SerialPort, TellsOnceWhenTheDeviceHangsUp) {
  PseudoTerminal device;
  boost::asio::io_context loop;
  SerialPortAnswer opened = open_serial_port(loop, device.path(), 9600);
  ASSERT_TRUE(opened.port) << opened.refused;
  std::unique_ptr<BytePort>& port = opened.port;
  int told = 0;
  std::string why;
  port->start({{}, [&](const std::string& reason) {
                 ++told;
                 why = reason;
                 port.reset();  // as a session does that gives up
               }});
  device.hang_up();
  run_until(loop, [&] { return told > 0; });
  loop.restart();
  loop.run_for(std::chrono::milliseconds(10));
  EXPECT_EQ(told, 1);
  EXPECT_NE(why.find("the device"), std::string::npos) << why;
}

TEST(SerialPort, CallsNoHandlerAfterItIsGone) {
  PseudoTerminal device;
  boost::asio::io_context loop;
  auto [port, refused, note] = open_serial_port(loop, device.path(), 9600);
  ASSERT_TRUE(port) << refused;
  port->start({[](std::span<const std::uint8_t>, Timestamp) { FAIL(); }, [](const std::string&) { FAIL(); }});
  port->set_baud(123);  // refused by the line: would be told
  device.send({1});
  port.reset();
  loop.run_for(std::chrono::milliseconds(20));
}

TEST(SerialPort, MayBeDestroyedByItsOwnHandler) {
  PseudoTerminal device;
  boost::asio::io_context loop;
  SerialPortAnswer opened = open_serial_port(loop, device.path(), 9600);
  ASSERT_TRUE(opened.port) << opened.refused;
  std::unique_ptr<BytePort>& port = opened.port;
  port->start({[&](std::span<const std::uint8_t>, Timestamp) { port.reset(); }, {}});
  device.send({1, 2, 3});
  run_until(loop, [&] { return port == nullptr; });
}

TEST(SerialPort, SaysThatADeviceIsBusyAndTakesItOnceItIsFree) {
  PseudoTerminal device;
  boost::asio::io_context loop;
  auto first = open_serial_port(loop, device.path(), 9600);
  ASSERT_TRUE(first.port);
  const auto second = open_serial_port(loop, device.path(), 9600);
  EXPECT_FALSE(second.port);
  EXPECT_TRUE(second.refused.starts_with(device.path() + " is busy: '")) << second.refused;
  EXPECT_NE(second.refused.find("(pid " + std::to_string(::getpid()) + ", running for "), std::string::npos)
      << second.refused;
  EXPECT_TRUE(second.refused.ends_with(" s) has it open")) << second.refused;
  first.port.reset();
  EXPECT_TRUE(open_serial_port(loop, device.path(), 9600).port);
}

TEST(SerialPort, NamesTheDeviceAndTheReasonItCannotBeUsed) {
  boost::asio::io_context loop;
  const test::TemporaryFolder folder;
  EXPECT_NE(open_serial_port(loop, "/dev/no-such-port", 9600).refused.find("/dev/no-such-port is missing"),
            std::string::npos);
  EXPECT_NE(open_serial_port(loop, folder.write("file", ""), 9600).refused.find("is not a serial port"),
            std::string::npos);
  PseudoTerminal device;
  EXPECT_NE(open_serial_port(loop, device.path(), 12345).refused.find("cannot run at 12345 baud"), std::string::npos);
}

}  // namespace
}  // namespace deltamap::drivers::port
