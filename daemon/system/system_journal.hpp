// SPDX-License-Identifier: Apache-2.0
// The log of a service: each line goes to systemd's journal with its priority, and what stands in it as key=value as a
// field of its own: "map changed: revision=7 …" is found by DELTAMAP_REVISION=7.
#pragma once

#include <string>
#include <vector>

#include "daemon/telemetry/log_level.hpp"

namespace deltamap::daemon::system_journal {

/// Standard error ends in the journal (JOURNAL_STREAM, systemd.exec(5)).
[[nodiscard]] bool is_behind_stderr();
/// "NAME=VALUE": MESSAGE, PRIORITY (3 error, 4 warn, 6 info, 7 below), SYSLOG_IDENTIFIER, and DELTAMAP_KEY for each
/// first key=value; a value ends at a blank, that of `reason` and `file` with the line.
[[nodiscard]] std::vector<std::string> fields_of(LogLevel level, const std::string& line);
/// False where the journal does not take it.
[[nodiscard]] bool write(LogLevel level, const std::string& line);

}  // namespace deltamap::daemon::system_journal
