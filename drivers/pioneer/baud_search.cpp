// SPDX-License-Identifier: Apache-2.0
#include "drivers/pioneer/baud_search.hpp"

#include <array>

namespace deltamap::drivers::pioneer {

std::vector<BaudProbe> baud_search(unsigned idle, unsigned left, unsigned wanted) {
  constexpr std::array<unsigned, 5> kSearchOrder{9600, 38400, 115200, 19200, 57600};  // A4.7
  constexpr Duration kQuick{300'000'000};      // ten times what an echo takes at 9600 baud
  constexpr Duration kPatient{1'000'000'000};  // A4.7: for lines by radio or network
  std::vector<BaudProbe> probes;
  if (wanted != idle && wanted != left) {
    probes.push_back({idle, kQuick});
    if (left != idle) probes.push_back({left, kQuick});
    probes.push_back({wanted, kQuick});
  }
  Duration at_idle = kQuick;
  for (const unsigned other : kSearchOrder) {
    if (other == idle || other == left || other == wanted) continue;
    probes.push_back({idle, at_idle});
    if (left != idle) probes.push_back({left, kQuick});
    probes.push_back({other, kQuick});
    at_idle = kPatient;
  }
  probes.push_back({idle, kPatient});
  return probes;
}

}  // namespace deltamap::drivers::pioneer
