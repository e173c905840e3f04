// SPDX-License-Identifier: Apache-2.0
// The golden frames of tests/data, which golden_frames.py builds from the protocol pages and from nothing of ours.
#pragma once

#include <cstdint>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/support/files/source_tree.hpp"

namespace deltamap::tests {

struct GoldenFrame {
  std::vector<std::uint8_t> bytes;
  nlohmann::json fields;  ///< what went into it: a line of NAME.expected

  [[nodiscard]] std::string name() const { return fields["name"]; }
};

struct GoldenStream {
  std::vector<std::uint8_t> bytes;  ///< all frames, one after another
  std::vector<GoldenFrame> frames;
};

[[nodiscard]] inline GoldenStream golden_stream(const std::string& name) {
  const std::string path = test::source_path("tests/data/") + name;
  std::ifstream bytes(path + ".bytes", std::ios::binary);
  GoldenStream stream{{std::istreambuf_iterator<char>(bytes), {}}, {}};
  std::ifstream expected(path + ".expected");
  for (std::string line; std::getline(expected, line);) {
    auto fields = nlohmann::json::parse(line);
    const auto begin = stream.bytes.begin() + fields["at"].get<std::ptrdiff_t>();
    stream.frames.push_back({{begin, begin + fields["size"].get<std::ptrdiff_t>()}, fields});
  }
  if (stream.frames.empty()) throw std::runtime_error(path + ": no golden frames");
  return stream;
}

}  // namespace deltamap::tests
