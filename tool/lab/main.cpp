// SPDX-License-Identifier: Apache-2.0
// The `deltamap-lab` command.
#include "tool/lab/run_lab.hpp"

int main(int argc, char** argv) { return deltamap::tool::run_lab(argc, argv); }
