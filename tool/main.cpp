// SPDX-License-Identifier: Apache-2.0
// The `deltamap` command.
#include "tool/run_tool.hpp"

int main(int argc, char** argv) { return deltamap::tool::run_tool(argc, argv); }
