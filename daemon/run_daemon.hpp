// SPDX-License-Identifier: Apache-2.0
// The command line of deltamapd and its main thread: start, one status line a second, watchdog, clean stop.
#pragma once

namespace deltamap::daemon {

/// Answers the exit code: 0 stopped in order, 1 could not start or a stage has failed, 2 wrong usage or settings.
[[nodiscard]] int run_daemon(int argc, const char* const* argv);

}  // namespace deltamap::daemon
