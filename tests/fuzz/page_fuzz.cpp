// SPDX-License-Identifier: Apache-2.0
// Sends damaged HTTP and WebSocket input to the live page's server, over real sockets, built with the sanitizers:
//   page_fuzz [--seconds S] [--seed N] [--case N] [--state FILE]
// A case is made from seed and number alone. Beside the sanitizers, three things must hold: whoever has no token never
// commands, but for STOP, and never drives, whatever comes back is HTTP, and the next good request is answered. Prints
// one JSON line; exit code 1 where one does not hold. FILE holds the number of the newest case, for whoever looks after
// a crash;
// --case plays it alone.
#include <netinet/in.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "daemon/control/request.hpp"
#include "daemon/dashboard/server.hpp"
#include "daemon/live/hand_drive.hpp"
#include "tests/fuzz/mutation.hpp"

namespace deltamap::fuzz {
namespace {

using namespace daemon;
using Clock = std::chrono::steady_clock;

constexpr const char* kToken = "of-the-fuzzer-0123456789";
constexpr int kPatience_ms = 8;  // for an answer; most damaged requests have none
constexpr int kDrivePatience_ms = 50;
constexpr const char* kTaken = "taken";  // the first word to whoever drives
constexpr int kGoodPatience_ms = 20'000;

struct Options {
  double seconds = 5.0;
  std::uint64_t seed = 1;
  std::optional<std::uint64_t> only;
  std::string state;
};

/// Some messages to a viewer.
class Few final : public dashboard::Stream {
 public:
  std::optional<dashboard::Message> next() override {
    if (left_ == 0) return std::nullopt;
    --left_;
    return dashboard::Message{.is_binary = left_ % 2 == 0, .bytes = std::make_shared<const std::string>(300, 'm')};
  }

 private:
  int left_ = 4;
};

/// The server as a daemon has it, with a robot that does what it is told.
class Page {
 public:
  Page() : server_{options()}, thread_{[this] { server_.run(); }} {}
  ~Page() {
    server_.stop();
    thread_.join();
  }
  [[nodiscard]] std::uint16_t port() const { return server_.port(); }
  /// A command was taken of somebody without the token.
  [[nodiscard]] bool is_broken_into() const { return is_broken_into_; }

 private:
  dashboard::Server::Options options() {
    dashboard::Server::Options options;
    options.guard = {.token = kToken, .takes_commands = true};
    options.answer = [](const dashboard::Request& request) { return dashboard::Answer{.body = request.path}; };
    options.open = [] { return std::make_unique<Few>(); };
    options.is_stop = [](const std::string& body) { return control::is_stop(body); };
    options.command = [this](const dashboard::Request& request, dashboard::Reply reply) {
      const bool has_token = request.authorization.find(kToken) != std::string::npos;
      if (!has_token && !control::is_stop(request.body)) is_broken_into_ = true;
      const auto read = control::request_of_line(request.body);
      reply({.status = read.request ? 200U : 409U,
             .body = read.request ? control::line_of(*read.request) : control::error_line(read.refused)});
    };
    options.converse = [this] {
      Hand hand{.take = [](std::uint64_t, const auto& answer) { answer({.ticket = 0, .done = true, .message = ""}); },
                .drive = [](std::uint64_t, const DriveCommand&) {},
                .let_go = [](std::uint64_t) {}};
      return std::make_unique<HandDrive>(++drivers_, std::move(hand), telemetry_,
                                         [] { return Timestamp{Clock::now().time_since_epoch()}; });
    };
    options.period_s = 0.002;
    return options;
  }
  Telemetry telemetry_;
  std::atomic<bool> is_broken_into_ = false;
  std::uint64_t drivers_ = 0;
  dashboard::Server server_;
  std::thread thread_;
};

class Client {
 public:
  explicit Client(std::uint16_t port) : descriptor_{::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)} {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const linger at_once{.l_onoff = 1, .l_linger = 0};  // no port stays behind in TIME_WAIT
    (void)::setsockopt(descriptor_, SOL_SOCKET, SO_LINGER, &at_once, sizeof at_once);
    if (::connect(descriptor_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
      std::perror("page_fuzz: connect");
      std::exit(1);
    }
  }
  ~Client() { (void)::close(descriptor_); }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  void send(std::string_view bytes) const {
    while (!bytes.empty()) {
      const ssize_t sent = ::send(descriptor_, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
      if (sent <= 0) return;  // it has hung up, or does not read: both may be
      bytes.remove_prefix(static_cast<std::size_t>(sent));
    }
  }
  void say_no_more() const { (void)::shutdown(descriptor_, SHUT_WR); }
  /// What comes until `end` is in it, or nothing more comes for so long.
  [[nodiscard]] std::string received(int patience_ms, std::string_view end) const {
    std::string bytes;
    pollfd ready{.fd = descriptor_, .events = POLLIN, .revents = 0};
    while (bytes.find(end) == std::string::npos && ::poll(&ready, 1, patience_ms) > 0) {
      char part[4096];
      const ssize_t n = ::recv(descriptor_, part, sizeof part, 0);
      if (n <= 0) break;
      bytes.append(part, static_cast<std::size_t>(n));
    }
    return bytes;
  }

 private:
  int descriptor_;
};

std::string upgrade(const std::string& path, const std::string& token) {
  return "GET " + path +
         " HTTP/1.1\r\nHost: 127.0.0.1:8484\r\nOrigin: http://127.0.0.1:8484\r\nConnection: Upgrade\r\n" +
         "Upgrade: websocket\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n" + token +
         "\r\n";
}

std::string request(Mutation& mutation, const std::string& token) {
  static const std::array<std::string, 9> paths{
      "/",         "/page/main.js", "/api/status",        "/api/map.png", "/metrics", "/api/revision/3/cells",
      "/?token=x", "/live",         "/api/history?a=%20b"};
  static const std::array<std::string, 6> bodies{R"({"command":"pause"})",
                                                 R"({"command":"undo","revision":3})",
                                                 R"({"command":"relocalize","x_m":1.5,"y_m":-2,"heading_rad":0.1})",
                                                 R"({"command":"drive","mode":"wander"})",
                                                 R"({"command":"log-level","level":"debug"})",
                                                 R"({"command":"status"})"};
  if (mutation.happens(4)) return upgrade(mutation.happens(2) ? "/live" : "/drive", token);
  if (mutation.happens(2)) {
    const std::string& body = mutation.one_of(bodies);
    return "POST /api/command HTTP/1.1\r\nHost: localhost:1\r\nContent-Type: application/json\r\nContent-Length: " +
           std::to_string(body.size()) + "\r\n" + token + "\r\n" + body;
  }
  return "GET " + mutation.one_of(paths) + " HTTP/1.1\r\nHost: [::1]:8484\r\nUser-Agent: f\r\nAccept: */*\r\n" + token +
         "\r\n";
}

std::string frame(Mutation& mutation, const std::string& payload) {
  static constexpr std::array<unsigned, 10> kFirst{0x81, 0x82, 0x88, 0x89, 0x8A, 0x01, 0x00, 0x80, 0xF1, 0x83};
  std::string bytes{static_cast<char>(mutation.one_of(kFirst))};
  if (payload.size() < 126) {
    bytes += static_cast<char>(0x80U | payload.size());
  } else {
    bytes += {'\xFE', static_cast<char>(payload.size() >> 8U), static_cast<char>(payload.size() & 0xFFU)};
  }
  const std::string mask = mutation.noise(5) + std::string(4, '\0');
  bytes += mask.substr(0, 4);
  for (std::size_t i = 0; i < payload.size(); ++i) bytes += static_cast<char>(payload[i] ^ mask[i % 4]);
  return bytes;
}

std::string frames(Mutation& mutation) {
  static const std::array<std::string, 5> payloads{R"({"beat":1,"speed_m_per_s":0.2,"turn_rate_rad_per_s":-0.5})",
                                                   R"({"beat":2,"speed_m_per_s":1e308})", "{}", "",
                                                   std::string("\x03\xE8gone")};
  std::string bytes;
  for (std::size_t i = 0; i <= mutation.below(4); ++i) {
    std::string payload = mutation.one_of(payloads);
    if (mutation.happens(2)) payload = mutation.changed(payload).substr(0, 2000);
    bytes += frame(mutation, payload);
  }
  return mutation.happens(2) ? mutation.changed(bytes) : bytes;
}

class Fuzzer {
 public:
  /// False where something does not hold.
  bool play(std::uint64_t seed, std::uint64_t number) {
    Mutation mutation{seed * 0x9E3779B97F4A7C15ULL + number};
    const bool has_token = !mutation.happens(3);
    const std::string token = has_token ? "Authorization: Bearer " + std::string{kToken} + "\r\n" : "";
    const Client client{page_.port()};
    if (has_token && mutation.happens(2)) return play_frames(client, mutation, token);
    std::string bytes = mutation.happens(20) ? mutation.noise(9000) : mutation.changed(request(mutation, token));
    if (mutation.happens(4)) bytes += mutation.changed(request(mutation, token));  // pipelined
    send_in_pieces(client, mutation, bytes);
    const std::string answer = client.received(kPatience_ms, "\r\n\r\n");
    const bool is_http = answer.empty() || (answer.starts_with("HTTP/1.") && answer.size() > 12);
    const std::string status = answer.empty() ? "none" : is_http ? answer.substr(9, 3) : "no HTTP";
    ++answers_[status];
    // A mutation cannot guess the token. Reading from this machine needs none.
    const bool drives =
        !has_token && status == "101" && client.received(kDrivePatience_ms, kTaken).find(kTaken) != std::string::npos;
    return is_http && !drives && !page_.is_broken_into();
  }

  /// A good request is answered, after all that came before.
  [[nodiscard]] bool is_well() const {
    const Client client{page_.port()};
    client.send("GET /api/status HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\nAuthorization: Bearer " +
                std::string{kToken} + "\r\n\r\n");
    return client.received(kGoodPatience_ms, "/api/status").starts_with("HTTP/1.1 200");
  }
  [[nodiscard]] const std::map<std::string, std::uint64_t>& answers() const { return answers_; }

 private:
  bool play_frames(const Client& client, Mutation& mutation, const std::string& token) {
    client.send(upgrade(mutation.happens(2) ? "/live" : "/drive", token));
    const std::string answer = client.received(kGoodPatience_ms, "\r\n\r\n");
    if (!answer.starts_with("HTTP/1.1 101")) {  // 32 viewers and 4 drivers at most
      ++answers_["full"];
      return answer.empty() || answer.starts_with("HTTP/1.1 ");
    }
    send_in_pieces(client, mutation, frames(mutation));
    if (mutation.happens(2)) (void)client.received(1, "\x88");
    ++answers_["frames"];
    return true;
  }
  static void send_in_pieces(const Client& client, Mutation& mutation, const std::string& bytes) {
    std::size_t sent = 0;
    while (sent < bytes.size() && mutation.happens(3)) {
      const std::size_t piece = 1 + mutation.below(bytes.size() - sent);
      client.send(std::string_view{bytes}.substr(sent, piece));
      sent += piece;
    }
    client.send(std::string_view{bytes}.substr(sent));
    if (mutation.happens(4)) client.say_no_more();
  }

  Page page_;
  std::map<std::string, std::uint64_t> answers_;
};

long peak_resident_kb() {
  rusage used{};
  (void)::getrusage(RUSAGE_SELF, &used);
  return used.ru_maxrss;
}

int fuzz(const Options& options) {
  constexpr std::uint64_t kLookEvery = 500;
  Fuzzer fuzzer;
  const auto began = Clock::now();
  const auto passed_s = [&] { return std::chrono::duration<double>(Clock::now() - began).count(); };
  std::uint64_t number = options.only.value_or(0);
  long early_kb = 0;
  bool holds = true;
  do {
    if (!options.state.empty()) std::ofstream(options.state) << options.seed << ' ' << number << '\n';
    holds = fuzzer.play(options.seed, number);
    if (holds && number % kLookEvery == 0) holds = fuzzer.is_well();
    if (number == 10 * kLookEvery) early_kb = peak_resident_kb();
    if (holds) ++number;
  } while (holds && !options.only && passed_s() < options.seconds);
  holds = holds && fuzzer.is_well();
  std::printf("{\"holds\":%s,\"seed\":%llu,\"cases\":%llu,\"seconds\":%.0f,\"grown_kb\":%ld,\"answers\":{",
              holds ? "true" : "false", static_cast<unsigned long long>(options.seed),
              static_cast<unsigned long long>(number), passed_s(), early_kb > 0 ? peak_resident_kb() - early_kb : 0L);
  const char* before = "";
  for (const auto& [status, count] : fuzzer.answers()) {
    std::printf("%s\"%s\":%llu", before, status.c_str(), static_cast<unsigned long long>(count));
    before = ",";
  }
  std::printf("}}\n");
  return holds ? 0 : 1;
}

}  // namespace
}  // namespace deltamap::fuzz

int main(int count, char** words) {
  deltamap::fuzz::Options options;
  for (int i = 1; i + 1 < count; i += 2) {
    const std::string name = words[i];
    if (name == "--seconds") options.seconds = std::atof(words[i + 1]);
    if (name == "--seed") options.seed = std::strtoull(words[i + 1], nullptr, 10);
    if (name == "--case") options.only = std::strtoull(words[i + 1], nullptr, 10);
    if (name == "--state") options.state = words[i + 1];
  }
  return deltamap::fuzz::fuzz(options);
}
