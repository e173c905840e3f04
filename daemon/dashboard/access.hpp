// SPDX-License-Identifier: Apache-2.0
// Who may read the live page: programs of this machine, and beyond it whoever has the token; and who may command by it.
// Knows no socket.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "daemon/dashboard/request.hpp"

namespace deltamap::daemon::dashboard {

inline constexpr std::size_t kShortestToken = 16;                 ///< characters
inline constexpr std::string_view kCommandPath = "/api/command";  ///< takes POST, and nothing else does
inline constexpr std::string_view kDrivePath = "/drive";          ///< a WebSocket that takes messages

/// Nothing where `address` is no IPv4 or IPv6 address.
[[nodiscard]] std::optional<bool> is_loopback(const std::string& address);

/// The token: the file's first line. Throws std::runtime_error with one line that names the file: unreadable, readable
/// by everybody, shorter than kShortestToken, or with other characters than letters, digits, '-', '_' and '.'.
[[nodiscard]] std::string read_token(const std::filesystem::path& file);

/// The token of that file, or an empty one where no file is named.
[[nodiscard]] inline std::string token_in(const std::filesystem::path& file) {
  return file.empty() ? std::string{} : read_token(file);
}

/// Takes as long for a wrong text as for the right one; only its length may show.
[[nodiscard]] bool is_same_secret(std::string_view given, std::string_view secret);

inline constexpr std::string_view kDrivingNeedsToken = "what moves the robot needs 'dashboard.token_file'";

struct Guard {
  std::string token{};          ///< empty: none is asked for
  bool takes_commands = false;  ///< from the page
};

/// Whether it comes with the token; never where there is none.
[[nodiscard]] bool is_known(const Request& request, const Guard& guard);

/// Why a request is not answered: another method than its path takes, a host that is a name (DNS rebinding), an origin
/// of another site, no or a wrong token (reading needs none from loopback, at a Host of loopback); a command where none
/// is taken, or not as JSON (a form of another site cannot send that); driving where there is no token at all. Nothing:
/// it may be answered.
[[nodiscard]] std::optional<Answer> refusal_of(const Request& request, const Guard& guard);

/// Whether a command is refused for want of the token alone, and by somebody who may read: STOP is taken of him.
[[nodiscard]] bool may_stop(const Request& request, const Guard& guard);

/// The answer to /?token=…: keeps the right token in a cookie and leads to the page. Nothing for any other request.
[[nodiscard]] std::optional<Answer> entry_of(const Request& request, const std::string& token);

}  // namespace deltamap::daemon::dashboard
