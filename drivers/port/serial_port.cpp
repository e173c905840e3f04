// SPDX-License-Identifier: Apache-2.0
#include "drivers/port/serial_port.hpp"

#include <unistd.h>

#include <utility>  // Boost 1.74's awaitable.hpp needs it and does not say so

#include <algorithm>
#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <cerrno>
#include <chrono>
#include <deque>
#include <system_error>
#include <vector>

#include "drivers/port/port_clock.hpp"
#include "drivers/port/terminal.hpp"

namespace deltamap::drivers::port {
namespace {

namespace asio = boost::asio;
using boost::system::error_code;
using Steady = std::chrono::steady_clock;

constexpr std::size_t kReadBytes = 65536;  // more than a terminal keeps for a program that stands still
constexpr std::size_t kMostInTime = 1024;  // a frame has at most 812 bytes: more than that at once has waited
constexpr auto kSettle = std::chrono::milliseconds(2);
constexpr auto kRestMargin = std::chrono::microseconds(500);   // two clocks differ, and a byte takes its time
constexpr auto kShortestRest = std::chrono::milliseconds(2);   // below that a timer costs more than it saves
constexpr auto kLongestRest = std::chrono::milliseconds(100);  // a length may be garbage, and a device be unplugged
constexpr auto kDrainPoll = std::chrono::milliseconds(2);
constexpr auto kDrainMargin = std::chrono::milliseconds(5);   // for what an adapter holds behind the kernel's queue
constexpr auto kDrainLimit = std::chrono::milliseconds(500);  // after which the baud changes, drained or not

/// One thing to be done on the line, in order.
struct Task {
  std::vector<std::uint8_t> bytes;  // to write; empty where it is a change of baud
  std::size_t written = 0;
  unsigned baud = 0;
};

/// Kept alive by its pending operations; they do nothing once it is closed. Waits for readiness and reads by itself
/// (asio::serial_port can only read), so that a stamp is taken as soon as read() has returned.
class SerialLine : public std::enable_shared_from_this<SerialLine> {
 public:
  SerialLine(asio::io_context& loop, int terminal, unsigned baud)
      : terminal_{terminal}, baud_{baud}, descriptor_{loop, terminal}, drain_timer_{loop}, rest_timer_{loop} {}
  ~SerialLine() { close(); }

  void start(PortHandlers handlers) {
    handlers_ = std::move(handlers);
    wait_for_input();
  }

  void add(Task task) {
    if (closed_) return;
    tasks_.push_back(std::move(task));
    if (tasks_.size() == 1) work();
  }

  void discard_input() {
    if (!closed_) discard_unread_bytes(terminal_);
    held_ = 0;
    rest_timer_.cancel();
  }

  void await(std::size_t bytes) { awaited_ = bytes; }

  void close() {
    if (closed_) return;
    closed_ = true;
    handlers_ = {};
    drain_timer_.cancel();
    rest_timer_.cancel();
    detach();
    close_terminal(terminal_);
  }

 private:
  /// Tells the reason once, from the loop and never from inside a call to the port.
  void fail(const std::string& reason) {
    if (failed_ || closed_) return;
    failed_ = true;
    tasks_.clear();
    asio::post(descriptor_.get_executor(), [self = shared_from_this(), reason] {
      if (self->closed_) return;
      const auto on_closed = self->handlers_.on_closed;
      self->close();
      if (on_closed) on_closed(reason);
    });
  }

  /// The loop hears of the terminal, or of nothing that it does: asio is woken by every byte that comes, wanted or not.
  bool attach() {
    error_code error;
    if (!descriptor_.is_open()) descriptor_.assign(terminal_, error);
    if (error) fail("the device cannot be listened to (" + error.message() + ")");
    return !error;
  }
  void detach() {
    if (descriptor_.is_open()) (void)descriptor_.release();
  }

  void wait_for_input() {
    if (!attach()) return;
    descriptor_.async_wait(asio::posix::stream_descriptor::wait_read,
                           [self = shared_from_this()](const error_code& error) {
                             if (error || self->closed_ || self->failed_) return;
                             self->read();
                           });
  }

  /// What has waited while this program, the kernel or an adapter stood still comes in pieces, one right after another,
  /// but is one chunk: each byte is dated by those that followed it (received_bytes.hpp).
  void read() {
    const std::size_t held_before = held_;
    const std::string gone = read_all();
    if (gone.empty() && held_ - held_before > kMostInTime && held_ < input_.size()) return read_after(kSettle);
    const std::size_t count = std::exchange(held_, 0);
    if (count > 0 && handlers_.on_bytes) {
      const auto on_bytes = handlers_.on_bytes;  // the handler may close this port
      on_bytes({input_.data(), count}, read_at_);
    }
    if (!gone.empty()) return fail(gone);
    if (!closed_ && !failed_) rest_or_wait(std::exchange(awaited_, 0));
  }

  /// A frame comes in twenty pieces and more: they are read together when all must have come, and still each byte is
  /// dated by those that followed it, but for the margin.
  void rest_or_wait(std::size_t awaited) {
    const auto rest =
        std::chrono::microseconds(std::int64_t{10'000'000} * static_cast<std::int64_t>(awaited) / baud_) + kRestMargin;
    if (rest < kShortestRest || !tasks_.empty()) return wait_for_input();
    detach();
    read_after(std::min<std::chrono::microseconds>(rest, kLongestRest));
  }

  /// Reads until nothing waits any more; returns why no more bytes will come, empty where the port lives on.
  std::string read_all() {
    while (held_ < input_.size()) {
      const ssize_t count = ::read(terminal_, input_.data() + held_, input_.size() - held_);
      const int error = errno;
      if (count > 0) {
        read_at_ = port_clock_now();
        held_ += static_cast<std::size_t>(count);
        if (static_cast<std::size_t>(count) < kMostInTime) break;  // no more waits
      } else if (count == 0) {
        return "the device hung up";
      } else if (error == EAGAIN) {
        break;
      } else if (error != EINTR) {
        return "the device is gone (" + std::generic_category().message(error) + ")";
      }
    }
    return "";
  }

  void read_after(std::chrono::microseconds pause) {
    rest_timer_.expires_after(pause);
    rest_timer_.async_wait([self = shared_from_this()](const error_code&) {
      if (!self->closed_ && !self->failed_) self->read();
    });
  }

  void work() {
    while (!tasks_.empty() && !closed_ && !failed_) {
      const bool done = tasks_.front().bytes.empty() ? change_baud(tasks_.front()) : write(tasks_.front());
      if (!done) return;
      tasks_.pop_front();
    }
  }

  bool write(Task& task) {
    while (task.written < task.bytes.size()) {
      const ssize_t count = ::write(terminal_, task.bytes.data() + task.written, task.bytes.size() - task.written);
      if (count < 0 && errno == EINTR) continue;
      if (count < 0 && errno == EAGAIN) {
        wait_for_output();
        return false;
      }
      if (count <= 0) {
        fail("the device does not take bytes (" + std::generic_category().message(errno) + ")");
        return false;
      }
      task.written += static_cast<std::size_t>(count);
      line_free_at_ = std::max(line_free_at_, Steady::now()) + std::chrono::microseconds(10'000'000ll * count / baud_);
    }
    return true;
  }

  void wait_for_output() {
    if (!attach()) return;
    descriptor_.async_wait(asio::posix::stream_descriptor::wait_write,
                           [self = shared_from_this()](const error_code& error) {
                             if (!error) self->work();
                           });
  }

  /// tcdrain() would block the loop, which serves the other port too; so this looks again and again until the line is
  /// free.
  bool change_baud(const Task& task) {
    const auto now = Steady::now();
    const bool busy = now < line_free_at_ + kDrainMargin || unsent_bytes(terminal_) > 0;
    if (busy && now < line_free_at_ + kDrainLimit) {
      drain_timer_.expires_after(kDrainPoll);
      drain_timer_.async_wait([self = shared_from_this()](const error_code& error) {
        if (!error) self->work();
      });
      return false;
    }
    if (const std::string why = set_line_speed(terminal_, task.baud); !why.empty()) {
      fail("the device " + why);
      return false;
    }
    baud_ = task.baud;
    rest_timer_.cancel();  // what is awaited no longer comes at the old speed
    return true;
  }

  int terminal_;
  unsigned baud_;
  asio::posix::stream_descriptor descriptor_;
  asio::steady_timer drain_timer_;
  asio::steady_timer rest_timer_;
  PortHandlers handlers_;
  std::array<std::uint8_t, kReadBytes> input_{};
  std::size_t held_ = 0;     // bytes in input_ that are not handed over yet
  std::size_t awaited_ = 0;  // before more is of use
  Timestamp read_at_;        // when the newest byte in input_ was read
  std::deque<Task> tasks_;
  Steady::time_point line_free_at_{};
  bool closed_ = false;
  bool failed_ = false;
};

class SerialPort final : public BytePort {
 public:
  SerialPort(asio::io_context& loop, std::string path, int terminal, unsigned baud)
      : path_{std::move(path)}, baud_{baud}, line_{std::make_shared<SerialLine>(loop, terminal, baud)} {}
  ~SerialPort() override { line_->close(); }

  void start(PortHandlers handlers) override { line_->start(std::move(handlers)); }
  void write(std::span<const std::uint8_t> bytes) override {
    if (!bytes.empty()) line_->add({{bytes.begin(), bytes.end()}, 0, 0});
  }
  void set_baud(unsigned baud) override {
    baud_ = baud;
    line_->add({{}, 0, baud});
  }
  void discard_input() override { line_->discard_input(); }
  void await(std::size_t bytes) override { line_->await(bytes); }
  [[nodiscard]] const std::string& name() const override { return path_; }
  [[nodiscard]] unsigned baud() const override { return baud_; }

 private:
  std::string path_;
  unsigned baud_;
  std::shared_ptr<SerialLine> line_;
};

}  // namespace

SerialPortAnswer open_serial_port(asio::io_context& loop, const std::string& path, unsigned baud) {
  OpenedTerminal opened = open_terminal(path, baud);
  if (opened.descriptor < 0) return {nullptr, std::move(opened.refused)};
  return {std::make_unique<SerialPort>(loop, path, opened.descriptor, baud), ""};
}

}  // namespace deltamap::drivers::port
