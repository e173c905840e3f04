// SPDX-License-Identifier: Apache-2.0
// A client of the live page over plain sockets: HTTP and WebSocket, as rude as a test needs it.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "tests/support/daemon/stream_socket.hpp"

namespace deltamap::test {

struct WebAnswer {
  int status = 0;  ///< 0: the server has hung up without an answer
  std::map<std::string, std::string> headers;
  std::string body;
};

struct WebFrame {
  unsigned opcode = 0;  ///< 1 text, 2 binary, 8 close, 9 ping
  std::string payload;
};

class WebClient {
 public:
  explicit WebClient(std::uint16_t port, int receive_buffer = 0) : socket_{AF_INET, receive_buffer} { connect(port); }
  /// Has its descriptor, and connects later.
  WebClient() : socket_{AF_INET} {}
  void connect(std::uint16_t port) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socket_.connect(address);
  }

  [[nodiscard]] bool is_connected() const { return socket_.is_connected(); }

  bool send(const std::string& bytes) const { return socket_.send(bytes); }

  [[nodiscard]] WebAnswer answer() {
    WebAnswer answer;
    std::string line = text_line();
    if (line.size() < 12) return answer;
    answer.status = std::atoi(line.c_str() + 9);
    for (line = text_line(); !line.empty(); line = text_line()) {
      const auto colon = line.find(": ");
      if (colon == std::string::npos) break;
      answer.headers[line.substr(0, colon)] = line.substr(colon + 2);
    }
    const auto length = answer.headers.find("Content-Length");
    if (length != answer.headers.end())
      answer.body = taken(static_cast<std::size_t>(std::atoi(length->second.c_str())));
    return answer;
  }

  /// Lines without their ends; a Host is added unless they bring one.
  [[nodiscard]] WebAnswer asked(const std::string& request_line, const std::string& headers = "") {
    const bool has_host = headers.find("Host:") != std::string::npos;
    (void)send(request_line + " HTTP/1.1\r\n" + (has_host ? "" : "Host: 127.0.0.1:1\r\n") + headers + "\r\n");
    return answer();
  }
  [[nodiscard]] WebAnswer got(const std::string& path, const std::string& headers = "") {
    return asked("GET " + path, headers);
  }
  [[nodiscard]] WebAnswer posted(const std::string& path, const std::string& body, const std::string& headers = "") {
    (void)send("POST " + path + " HTTP/1.1\r\nHost: 127.0.0.1:1\r\nContent-Type: application/json\r\nContent-Length: " +
               std::to_string(body.size()) + "\r\n" + headers + "\r\n" + body);
    return answer();
  }
  [[nodiscard]] WebAnswer upgraded(const std::string& headers = "", const std::string& path = "/live") {
    return got(path,
               "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
               "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n" +
                   headers);
  }

  /// Nothing where the connection has ended.
  [[nodiscard]] std::optional<WebFrame> frame() {
    const std::string head = taken(2);
    if (head.size() < 2) return std::nullopt;
    const auto byte = [](const std::string& text, std::size_t i) { return static_cast<unsigned char>(text[i]); };
    std::uint64_t length = byte(head, 1) & 0x7FU;
    if (length >= 126) {
      const std::string more = taken(length == 126 ? 2 : 8);
      length = 0;
      for (std::size_t i = 0; i < more.size(); ++i) length = length << 8U | byte(more, i);
    }
    WebFrame frame{byte(head, 0) & 0x0FU, taken(static_cast<std::size_t>(length))};
    if (frame.payload.size() < length) return std::nullopt;
    return frame;
  }
  /// With a mask of zeros, as a client must have one.
  bool send_frame(unsigned opcode, const std::string& payload) const {
    std::string bytes{static_cast<char>(0x80U | opcode)};
    if (payload.size() < 126) {
      bytes += static_cast<char>(0x80U | payload.size());
    } else {  // 16 bits
      bytes +=
          {static_cast<char>(0xFE), static_cast<char>(payload.size() >> 8U), static_cast<char>(payload.size() & 0xFFU)};
    }
    return send(bytes + std::string(4, '\0') + payload);
  }
  /// Says no more, and reads until the server hangs up.
  [[nodiscard]] bool finishes() {
    (void)::shutdown(socket_.descriptor(), SHUT_WR);
    return is_hung_up();
  }
  /// Reads until the server hangs up. False where it does not within the patience of the socket.
  [[nodiscard]] bool is_hung_up() {
    char bytes[4096];
    for (;;) {
      const ssize_t n = ::recv(socket_.descriptor(), bytes, sizeof bytes, 0);
      if (n == 0) return true;
      if (n < 0 && errno == EINTR) continue;
      if (n < 0) return errno == ECONNRESET || errno == EPIPE;
    }
  }

 private:
  [[nodiscard]] std::string text_line() {
    for (;;) {
      if (const auto end = received_.find("\r\n"); end != std::string::npos) {
        std::string line = received_.substr(0, end);
        received_.erase(0, end + 2);
        return line;
      }
      if (!receive()) return std::exchange(received_, {});
    }
  }
  [[nodiscard]] std::string taken(std::size_t size) {
    while (received_.size() < size && receive()) {
    }
    std::string text = received_.substr(0, size);
    received_.erase(0, size);
    return text;
  }
  bool receive() { return socket_.receive(received_); }

  StreamSocket socket_;
  std::string received_;
};

}  // namespace deltamap::test
