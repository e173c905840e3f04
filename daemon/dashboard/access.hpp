// SPDX-License-Identifier: Apache-2.0
// Who may read the live page: programs of this machine, and beyond it whoever has the token. Knows no socket.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "daemon/dashboard/request.hpp"

namespace deltamap::daemon::dashboard {

inline constexpr std::size_t kShortestToken = 16;  ///< characters

/// Nothing where `address` is no IPv4 or IPv6 address.
[[nodiscard]] std::optional<bool> is_loopback(const std::string& address);

/// The token: the file's first line. Throws std::runtime_error with one line that names the file: unreadable, readable
/// by everybody, shorter than kShortestToken, or with other characters than letters, digits, '-', '_' and '.'.
[[nodiscard]] std::string read_token(const std::filesystem::path& file);

/// Takes as long for a wrong text as for the right one; only its length may show.
[[nodiscard]] bool is_same_secret(std::string_view given, std::string_view secret);

/// Why a request is not answered: another method than GET, a host that is a name (DNS rebinding), an origin of another
/// site, no or a wrong token. Nothing: it may be answered. `token`: empty where none is asked for.
[[nodiscard]] std::optional<Answer> refusal_of(const Request& request, const std::string& token);

/// The answer to /?token=…: keeps the right token in a cookie and leads to the page. Nothing for any other request.
[[nodiscard]] std::optional<Answer> entry_of(const Request& request, const std::string& token);

}  // namespace deltamap::daemon::dashboard
