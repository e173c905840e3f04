// SPDX-License-Identifier: Apache-2.0
// deltamapd: the robot's daemon. Reads its settings, runs the pipeline until SIGTERM or SIGINT, and ends in order.
#include "daemon/run_daemon.hpp"

int main(int argc, char** argv) { return deltamap::daemon::run_daemon(argc, argv); }
