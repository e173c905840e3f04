// SPDX-License-Identifier: Apache-2.0
// What the command lines of all programs beside the daemon answer in the same way: wrong usage, an error, help.
#pragma once

namespace CLI {
class App;
}

namespace deltamap::tool {

/// Reads the words and does what they ask. The exit code: 0 done, 1 could not (one line on standard error), 2 wrong
/// usage.
[[nodiscard]] int answer_of(CLI::App& app, int argc, const char* const* argv);

}  // namespace deltamap::tool
