// SPDX-License-Identifier: Apache-2.0
// Reads the command line of `deltamap` and runs one subcommand.
#pragma once

namespace deltamap::tool {

/// Answers the exit code: 0 done, 1 could not (one line on standard error), 2 wrong usage.
[[nodiscard]] int run_tool(int argc, const char* const* argv);

}  // namespace deltamap::tool
