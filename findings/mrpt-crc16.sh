#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Guess: the checksum of a SICK LMS200 telegram (MRPT's compute_CRC16, polynomial 0x8005, as the manual prints it) is one of
#   the catalogued CRC-16 of that polynomial, and finds any two flipped bits of a telegram.
# Seen: it is none of them, whatever the start value, reflection and final XOR, since it shifts by one BIT a byte. Two
#   flips, bit k of one byte and bit k+n of the n-th byte after it, cancel out: in 20 bytes 448 of 12720 pairs go unseen,
#   where a CRC-16 of 0x8005 misses none.
# Matters: a disturbed line needs no luck to pass: neighbouring bytes are enough. Ranges that passed the checksum still
#   want a check of plausibility, and CRC libraries cannot be used for this laser.
# Version: MRPT 2.5.8 (1:2.5.8+ds-2). Source: SICK's "Telegrams for Configuring and Operating the LMS2xx", chapter 9, gives
#   the same steps; MRPT's crc.h calls it "the CRC16 checksum".
set -euo pipefail
source "$(dirname "$0")/lib/pinned.bash"

debian_programs libmrpt-system2.5=1:2.5.8+ds-2
debian_files libmrpt-{common,core,containers,system,typemeta}-dev=1:2.5.8+ds-2
cat > crc.cpp << 'CPP'
#include <mrpt/system/crc.h>

#include <cstdio>
#include <string>
#include <vector>

using Bytes = std::vector<uint8_t>;

unsigned reflected(unsigned value, int bits) {
  unsigned mirrored = 0;
  for (int i = 0; i < bits; ++i) mirrored |= (value >> i & 1u) << (bits - 1 - i);
  return mirrored;
}

/// A catalogued CRC-16 before reflection and XOR of its result.
unsigned crc16(const Bytes& bytes, unsigned start, bool reflects_bytes) {
  unsigned crc = start;
  for (const unsigned byte : bytes) {
    crc ^= (reflects_bytes ? reflected(byte, 8) : byte) << 8;
    for (int i = 0; i < 8; ++i) crc = (crc << 1 ^ ((crc & 0x8000u) != 0 ? 0x8005u : 0u)) & 0xFFFFu;
  }
  return crc;
}

template <class Checksum>
int unseen_pairs(const Checksum& checksum) {
  const Bytes telegram(20, 0x55);
  int unseen = 0;
  for (int first = 0; first < 160; ++first) {
    for (int second = first + 1; second < 160; ++second) {
      Bytes flipped = telegram;
      flipped[first / 8] ^= 1u << first % 8;
      flipped[second / 8] ^= 1u << second % 8;
      unseen += checksum(flipped) == checksum(telegram) ? 1 : 0;
    }
  }
  return unseen;
}

int main() {
  const std::string digits = "123456789";
  const Bytes check(digits.begin(), digits.end());
  const unsigned sick = mrpt::system::compute_CRC16(check);
  int equal = 0;
  for (const unsigned start : {0u, 0xFFFFu, 0x800Du}) {
    for (const bool reflects_bytes : {false, true}) {
      const unsigned crc = crc16(check, start, reflects_bytes);
      for (const unsigned result : {crc, reflected(crc, 16), crc ^ 0xFFFFu, reflected(crc, 16) ^ 0xFFFFu})
        equal += result == sick ? 1 : 0;
    }
  }
  std::printf("%04X for 123456789, equal to %d catalogued; pairs unseen %d, by CRC-16 %d", sick, equal,
              unseen_pairs([](const Bytes& bytes) { return mrpt::system::compute_CRC16(bytes); }),
              unseen_pairs([](const Bytes& bytes) { return crc16(bytes, 0, true); }));
}
CPP
compiled crc.cpp -isystem "$root/usr/include/mrpt/core/include" -isystem "$root/usr/include/mrpt/system/include" \
  -isystem "$root/usr/include" -lmrpt-system -lmrpt-core
stated 'compute_CRC16' 'A656 for 123456789, equal to 0 catalogued; pairs unseen 448, by CRC-16 0' "$(with_libraries ./run)"
