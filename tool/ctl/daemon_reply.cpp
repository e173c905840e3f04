// SPDX-License-Identifier: Apache-2.0
#include "tool/ctl/daemon_reply.hpp"

#include <nlohmann/json.hpp>

#include "daemon/control/client.hpp"

namespace deltamap::tool {

DaemonReply reply_to(const daemon::control::Request& request, const std::filesystem::path& socket) {
  DaemonReply reply;
  reply.line = daemon::control::exchange(socket, daemon::control::line_of(request));
  const auto json = nlohmann::ordered_json::parse(reply.line, nullptr, false);
  const auto has = [&](const char* key, auto is) { return json.contains(key) && (json[key].*is)(); };
  if (!json.is_object() || !has("ok", &nlohmann::ordered_json::is_boolean)) {
    throw std::runtime_error(socket.string() + ": no daemon of ours");
  }
  reply.ok = json["ok"].get<bool>();
  const char* words = reply.ok ? "message" : "error";
  reply.words = has(words, &nlohmann::ordered_json::is_string)
                    ? json[words].get<std::string>()
                    : std::string(reply.ok ? "done" : "the daemon could not");
  if (has("line", &nlohmann::ordered_json::is_string)) reply.status_line = json["line"].get<std::string>();
  if (has("since_start_s", &nlohmann::ordered_json::is_number))
    reply.since_start_s = json["since_start_s"].get<double>();
  return reply;
}

}  // namespace deltamap::tool
