#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Guess: modbus_set_float_abcd() and the three other setters with an order in their names write what the getters of the same
#   names read, and ABCD is the order of the wire, 47F1 2000 for 123456.
# Seen: the getters do, and none of the setters: abcd writes BADC, badc ABCD, cdab DCBA and dcba CDAB. 123456 that is written
#   and read back by the same name is -9.85e29. The old pair without an order, modbus_set_float(), agrees with itself (CDAB).
# Matters: a set point that a dispatcher sends as a float is nonsense, which its own reading back confirms as the device's
#   fault. With dcba in place of abcd on one side alone it seems mended, until the library is updated.
# Version: libmodbus 3.1.6 (3.1.6-2.1+deb12u1). Source: modbus_set_float_abcd(3): "in usual Modbus format", ABCD order;
#   modbus_get_float_abcd(3) says the same.
set -euo pipefail
source "$(dirname "$0")/lib/pinned.bash"

debian_files libmodbus5=3.1.6-2.1+deb12u1 libmodbus-dev=3.1.6-2.1+deb12u1
cat > orders.cpp << 'CPP'
#include <modbus/modbus.h>

#include <cstdio>

int main() {
  const struct {
    const char* name;
    void (*set)(float, uint16_t*);
    float (*get)(const uint16_t*);
    uint16_t as_named[2];  // 123456 is 47 F1 20 00
  } orders[] = {{"abcd", modbus_set_float_abcd, modbus_get_float_abcd, {0x47F1, 0x2000}},
                {"badc", modbus_set_float_badc, modbus_get_float_badc, {0xF147, 0x0020}},
                {"cdab", modbus_set_float_cdab, modbus_get_float_cdab, {0x2000, 0x47F1}},
                {"dcba", modbus_set_float_dcba, modbus_get_float_dcba, {0x0020, 0xF147}},
                {"old", modbus_set_float, modbus_get_float, {0x2000, 0x47F1}}};
  for (const auto& order : orders) {
    uint16_t written[2];
    order.set(123456.0f, written);
    std::printf("%s: got %g, set %04X %04X, back %g\n", order.name, order.get(order.as_named), written[0], written[1],
                order.get(written));
  }
}
CPP
compiled orders.cpp -l:libmodbus.so.5
expected='abcd: got 123456, set F147 0020, back -9.85403e+29|badc: got 123456, set 47F1 2000, back -9.85403e+29|'
expected+='cdab: got 123456, set 0020 F147, back -9.85403e+29|dcba: got 123456, set 2000 47F1, back -9.85403e+29|'
expected+='old: got 123456, set 2000 47F1, back 123456'
stated 'from registers as named; to registers; both' "$expected" "$(with_libraries ./run | paste -sd '|')"
