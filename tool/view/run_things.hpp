// SPDX-License-Identifier: Apache-2.0
// The things of a run as its page shows them: what things.jsonl of the run's folder tells up to a moment. The page asks
// at every move of its slider: each line is read once to know its time and thing, and again where it is shown.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "core/time.hpp"

namespace deltamap::tool {

class RunThings {
 public:
  /// The file may come to be later.
  explicit RunThings(std::filesystem::path things_jsonl) : file_{std::move(things_jsonl)} {}

  /// {"ok":true,"things":[…],"unread":N}: of each thing the newest line up to `time`, in the order of their ids. N
  /// lines are no lines of things.jsonl; one that is still being written does not count. Without a file there is no
  /// thing. A file that was begun anew is read anew.
  [[nodiscard]] std::string at(Timestamp time);

 private:
  struct Line {
    double time_s = 0.0;  // Unix
    std::uint32_t thing = 0;
    std::uint64_t begins = 0;  // in the file, bytes
  };
  [[nodiscard]] static std::string line_at(std::ifstream& in, std::uint64_t begins);
  [[nodiscard]] bool goes_on(std::ifstream& in) const;
  void read_on(std::ifstream& in);

  std::filesystem::path file_;
  std::vector<Line> lines_;  // as in the file
  std::string first_;        // line of the file
  std::size_t unread_ = 0;
  std::uint64_t read_to_ = 0;  // behind the last whole line
};

}  // namespace deltamap::tool
