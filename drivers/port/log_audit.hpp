// SPDX-License-Identifier: Apache-2.0
// What other programs have done to a recording, told by the seals of its packets and by what is left of them: taken
// out, changed, cut, joined, moved in time.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "drivers/port/log_faults.hpp"
#include "drivers/port/packet_seal.hpp"

namespace deltamap::drivers::port {

class LogAudit {
 public:
  /// A packet that is as it was written. `byte`: its place in the file; of the others, too.
  void sealed(std::uint32_t number, std::uint64_t byte);
  void unnumbered(std::uint64_t byte) { unnumbered_.add(byte); }
  /// Without a number too, which would tell by its checksum that it was so written.
  void undirected(std::uint64_t byte) { undirected_.add(byte); }
  /// This program has written it: what it writes has numbers and directions.
  void is_ours() { is_ours_ = true; }
  /// Not as it was written, perhaps in its number too, and left out.
  void changed(std::uint32_t number, std::uint64_t byte) {
    changed_.add(byte);
    pass_over(number);
  }
  /// Left out: another program has kept only the beginning of its bytes. Without a number in older recordings.
  void snapped(std::optional<std::uint32_t> number, std::uint64_t byte) {
    snapped_.add(byte);
    if (number) pass_over(*number);
  }
  /// A packet that was written for its note alone, and has none.
  void silenced(std::uint64_t byte) { silenced_.add(byte); }
  void stampless(std::uint64_t byte) { stampless_.add(byte); }
  /// Whether this is the number behind the newest packet's.
  [[nodiscard]] bool is_next(std::uint32_t number) const { return number == expected_; }
  void foreign(const std::string& interface) { ++foreign_[interface]; }
  /// The mark at its end: the time that it tells, and the time that its packet has.
  void end(Timestamp told, Timestamp stamp);

  /// `is_whole`: the file was read to its end.
  [[nodiscard]] LogFaults faults(const std::string& file, bool is_whole) const;

 private:
  void pass_over(std::uint32_t number) {
    if (is_next(number)) ++expected_;
    ++numbered_;
  }
  struct Tally {
    std::uint64_t count = 0;
    std::uint64_t first_byte = 0;
    void add(std::uint64_t byte, std::uint64_t more = 1) {
      if (count == 0) first_byte = byte;
      count += more;
    }
    /// "3 packets WHAT (the first at byte 77)"
    [[nodiscard]] std::string line(const std::string& what) const;
  };

  /// A line for each kind of packet that is missing, left out or not as it was written.
  [[nodiscard]] std::vector<std::string> lacks() const;
  [[nodiscard]] std::string why_unchecked() const;

  std::uint64_t numbered_ = 0;
  std::uint32_t expected_ = 0;
  Tally missing_, unnumbered_, undirected_, changed_, snapped_, silenced_, stampless_;
  Tally steps_back_;  // of the numbers
  std::map<std::string, std::uint64_t> foreign_;
  bool is_ours_ = false;
  bool has_end_ = false;
  double moved_s_ = 0.0;
};

}  // namespace deltamap::drivers::port
