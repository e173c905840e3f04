// SPDX-License-Identifier: Apache-2.0
// The command line of `deltamap-lab`: drives simulated robots until the figures of an experiment are known. A program
// of its own, for operators do not need it and it takes as long to build as all the rest.
#pragma once

namespace deltamap::tool {

/// Exit codes as run_tool().
[[nodiscard]] int run_lab(int argc, const char* const* argv);

}  // namespace deltamap::tool
