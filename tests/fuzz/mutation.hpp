// SPDX-License-Identifier: Apache-2.0
// What damage does to bytes on their way: a seeded source of changed copies.
#pragma once

#include <array>
#include <cstdint>
#include <random>
#include <string>
#include <string_view>
#include <vector>

namespace deltamap::fuzz {

class Mutation {
 public:
  explicit Mutation(std::uint64_t seed) : random_{seed} {}

  [[nodiscard]] std::size_t below(std::size_t count) {
    return count == 0 ? 0 : static_cast<std::size_t>(random_() % count);
  }
  [[nodiscard]] bool happens(unsigned in) { return below(in) == 0; }
  template <typename Items>
  [[nodiscard]] const auto& one_of(const Items& items) {
    return items[below(std::size(items))];
  }

  /// A few changes: flipped, dropped, doubled and inserted bytes, words that parsers stumble over, pieces moved.
  [[nodiscard]] std::string changed(std::string bytes) {
    const std::size_t changes = 1 + below(happens(4) ? 20 : 4);
    for (std::size_t i = 0; i < changes; ++i) change(bytes);
    return bytes;
  }
  [[nodiscard]] std::string noise(std::size_t most) {
    std::string bytes(below(most), '\0');
    for (char& byte : bytes) byte = static_cast<char>(random_());
    return bytes;
  }

 private:
  void change(std::string& bytes) {
    static constexpr std::array<std::string_view, 24> kWords{"\r\n",
                                                             "\n",
                                                             "\r\n\r\n",
                                                             " ",
                                                             "\t",
                                                             "\0\0",
                                                             ":",
                                                             "0",
                                                             "-1",
                                                             "4096",
                                                             "4097",
                                                             "18446744073709551616",
                                                             "1e999",
                                                             "%00",
                                                             "..",
                                                             "//",
                                                             "chunked",
                                                             "Content-Length: 5\r\n",
                                                             "Host: 127.0.0.1\r\n",
                                                             "Transfer-Encoding: chunked\r\n",
                                                             "{",
                                                             "\"",
                                                             "\\ud800",
                                                             "[[[[[[[["};
    const std::size_t at = below(bytes.size() + 1);
    switch (below(8)) {
      case 0:
        if (!bytes.empty()) bytes[below(bytes.size())] ^= static_cast<char>(1U << below(8));
        break;
      case 1:
        if (!bytes.empty()) bytes[below(bytes.size())] = static_cast<char>(random_());
        break;
      case 2:
        bytes.erase(at, 1 + below(16));
        break;
      case 3:
        bytes.insert(at, one_of(kWords));
        break;
      case 4:
        bytes.insert(at, bytes.substr(below(bytes.size() + 1), below(64)));
        break;
      case 5:
        bytes.resize(at);
        break;
      case 6:
        bytes.insert(at, std::string(below(happens(8) ? 20'000 : 300), static_cast<char>(random_())));
        break;
      default:
        bytes.insert(at, noise(32));
    }
  }

  std::mt19937_64 random_;
};

}  // namespace deltamap::fuzz
