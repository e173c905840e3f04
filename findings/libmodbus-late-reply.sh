#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Guess: a reply over RTU that comes after its time-out spoils one request at most: the next one finds it in the input, sees
#   that it is not the one asked for, and an error is told.
# Seen: one slow reply, and from then on every read returns the register that was asked for before, for as long as the
#   connection lasts: each call succeeds, by the reply of the call before it. RTU replies hold no register number and no
#   transaction, and nothing is thrown away. MODBUS_ERROR_RECOVERY_PROTOCOL, which flushes, changes nothing, as the reply is
#   no broken one; MODBUS_ERROR_RECOVERY_LINK, told to be for lost connections, is what helps.
# Matters: a gate's "closed" is read as the lamp's "on", with good checksums and no error after the first. Set the recovery of
#   the link, or pause and modbus_flush() after a time-out, and poll registers in one block.
# Version: libmodbus 3.1.6 (3.1.6-2.1+deb12u1). Source: "Modbus over serial line" 1.02, 2.4.1: a master that waits no longer
#   must be ready for a late reply; modbus_set_error_recovery(3) has no recovery as its default.
set -euo pipefail
source "$(dirname "$0")/lib/pinned.bash"

debian_files libmodbus5=3.1.6-2.1+deb12u1 libmodbus-dev=3.1.6-2.1+deb12u1
cat > line.cpp << 'CPP'
#include <modbus/modbus.h>
#include <pty.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <thread>

using namespace std::chrono_literals;

/// A device whose register N holds N; it takes 450 ms for its first reply, 100 ms for each other.
void serve(int line) {
  for (auto takes = 450ms;; takes = 100ms) {
    unsigned char asked[8];
    for (int have = 0; have < 8;) {
      const ssize_t more = read(line, asked + have, 8 - have);
      if (more <= 0) return;
      have += more;
    }
    unsigned char reply[7] = {asked[0], 3, 2, asked[2], asked[3]};
    unsigned sum = 0xFFFF;
    for (int i = 0; i < 5; ++i) {
      sum ^= reply[i];
      for (int bit = 0; bit < 8; ++bit) sum = (sum & 1) != 0 ? sum >> 1 ^ 0xA001 : sum >> 1;
    }
    reply[5] = sum & 0xFF, reply[6] = sum >> 8;
    std::this_thread::sleep_for(takes);
    if (write(line, reply, 7) != 7) return;
  }
}

int main(int, char** arguments) {
  int device = 0, ours = 0;
  char name[64];
  openpty(&device, &ours, name, nullptr, nullptr);
  std::thread(serve, device).detach();
  modbus_t* master = modbus_new_rtu(name, 115200, 'N', 8, 1);
  modbus_set_slave(master, 1);
  modbus_set_response_timeout(master, 0, 300000);
  modbus_set_error_recovery(master, static_cast<modbus_error_recovery_mode>(std::atoi(arguments[1])));
  modbus_connect(master);
  for (int number = 100; number < 108; ++number) {
    uint16_t value = 0;
    if (modbus_read_registers(master, number, 1, &value) == 1) std::printf("%d=%d ", number, value);
    else std::printf("%d:- ", number);
  }
  std::fflush(stdout);
  std::_Exit(0);
}
CPP
compiled line.cpp -l:libmodbus.so.5 -lutil -lpthread
before='100:- 101=100 102=101 103=102 104=103 105=104 106=105 107=106 '
stated 'recovery none' "$before" "$(with_libraries timeout 20 ./run 0)"
stated 'recovery protocol' "$before" "$(with_libraries timeout 20 ./run 4)"
stated 'recovery link' "${before%101=*}101=101 102=102 103=103 104=104 105=105 106=106 107=107 " "$(with_libraries timeout 20 ./run 2)"
