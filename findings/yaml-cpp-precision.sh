#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Guess: YAML::Precision(3) writes three decimals, so the map descriptions that nav2's map saver writes with it keep the
#   origin to the millimetre.
# Seen: it writes three significant digits. An origin of -12.345 becomes -12.3, -123.456 becomes -123, and 1234.5
#   becomes 1.23e+03. Small numbers (resolution 0.05) show nothing of it.
# Matters: a map saved by nav2 lies up to 5 cm off where its corner is more than 10 m from the origin, half a metre
#   beyond 100 m, against the map it was saved from and against poses, stations and zones that were taught on that one.
# Version: yaml-cpp 0.7.0 (0.7.0+dfsg-8+b1). Source: navigation2, nav2_map_server/src/map_io.cpp (Precision(3) before
#   resolution and origin); yaml-cpp's issue 761 recommends Precision(3) to somebody who asks for decimal places.
set -euo pipefail
source "$(dirname "$0")/lib/pinned.bash"

debian_programs libyaml-cpp0.7=0.7.0+dfsg-8+b1
debian_files libyaml-cpp-dev=0.7.0+dfsg-8+b1
cat > origin.cpp << 'CPP'
#include <yaml-cpp/yaml.h>

#include <iostream>

int main() {
  YAML::Emitter description;
  description << YAML::Precision(3) << YAML::Flow << YAML::BeginSeq;
  for (const double number : {0.05, 0.0125, -1.2345, -12.345, -123.456, 1234.5}) description << number;
  description << YAML::EndSeq;
  std::cout << description.c_str();
}
CPP
compiled origin.cpp -lyaml-cpp
stated '0.05 0.0125 -1.2345 -12.345 -123.456 1234.5 with Precision(3)' '[0.05, 0.0125, -1.23, -12.3, -123, 1.23e+03]' \
  "$(with_libraries ./run)"
