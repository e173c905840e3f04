// SPDX-License-Identifier: Apache-2.0
// What a browser asks and what it is answered, without the library that speaks HTTP.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace deltamap::daemon::dashboard {

/// The parts of a request that decide anything. Absent header fields are empty.
struct Request {
  std::string method{};  ///< "GET"
  std::string path{};    ///< "/api/status": the target up to its '?'
  std::string query{};   ///< what follows the '?'
  std::string host{};
  std::string origin{};
  std::string cookie{};
  std::string authorization{};
  std::string content_type{};
  std::string body{};             ///< of a command, else empty
  bool is_from_loopback = false;  ///< the sender's address
};

struct Answer {
  unsigned status = 200;
  std::string type = "text/plain; charset=utf-8";
  std::string body;
  std::vector<std::pair<std::string, std::string>> headers{};  ///< beside those that every answer has
};

/// Any thread, now or later; the first one counts.
using Reply = std::function<void(Answer)>;

/// One message to viewers; several viewers share its bytes.
struct Message {
  bool is_binary = false;
  std::shared_ptr<const std::string> bytes;
};

/// What one viewer is sent. It keeps what is due as marks, not as messages: a slow viewer skips what has become old.
class Stream {
 public:
  Stream() = default;
  virtual ~Stream() = default;
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;
  /// The next message; nothing until there is news.
  [[nodiscard]] virtual std::optional<Message> next() = 0;
};

/// Somebody who is sent messages and sends some. Destroyed when the connection ends, for whatever reason.
class Dialog : public Stream {
 public:
  virtual void hear(const std::string& message) = 0;
  /// Nothing is heard any more: what next() still has is sent, then the connection ends.
  [[nodiscard]] virtual bool is_over() const = 0;
};

}  // namespace deltamap::daemon::dashboard
