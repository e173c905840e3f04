// SPDX-License-Identifier: Apache-2.0
// The `deltamap` command.
#include "daemon/tool/run_tool.hpp"

int main(int argc, char** argv) { return deltamap::daemon::tool::run_tool(argc, argv); }
