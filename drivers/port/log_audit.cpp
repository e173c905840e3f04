// SPDX-License-Identifier: Apache-2.0
#include "drivers/port/log_audit.hpp"

#include <cstdio>

#include "core/counted.hpp"

namespace deltamap::drivers::port {
namespace {

constexpr const char* kOutOfOrder =
    "out of order: recordings were joined, packets doubled or put in another order; give one recording in the order "
    "in which it was written";
constexpr const char* kMissing =
    "missing before later ones: another program took them out, or the disk was full; the recording as it was "
    "written has them";
constexpr const char* kSnapped = "cut by a snap length, and left out; the recording as it was written has them whole";
constexpr const char* kChanged =
    "changed since they were written, by another program or by damage, and left out; the recording as it was written "
    "has them";
constexpr const char* kSilenced = "without the note that they were written for: another program took it out";
constexpr const char* kStampless = "without a time (simple or obsolete packet blocks), and left out";
constexpr const char* kNumberless = "without a number: another program has added or changed them";
constexpr const char* kEndMissing =
    "its end is missing: whoever wrote it was ended, is still writing or has reached recording.max_gigabytes, or "
    "another program has cut the end off";

std::string words_of_move(double moved_s) {
  char text[128];
  (void)std::snprintf(text, sizeof text,
                      "its times were moved by %+.9g s after it was written; its notes tell the old ones", moved_s);
  return text;
}

}  // namespace

std::string LogAudit::Tally::line(const std::string& what) const {
  return counted(count, "packet") + " " + what + " (the first at byte " + std::to_string(first_byte) + ")";
}

void LogAudit::sealed(std::uint32_t number, std::uint64_t byte) {
  if (number < expected_) {
    steps_back_.add(byte);
    has_end_ = false;
  } else if (number > expected_) {
    missing_.add(byte, number - expected_);
  }
  expected_ = number + 1;
  ++numbered_;
}

void LogAudit::end(Timestamp told, Timestamp stamp) {
  has_end_ = true;
  moved_s_ = seconds(stamp - told);
}

std::vector<std::string> LogAudit::lacks() const {
  struct Row {
    const Tally& tally;
    bool tells;
    const char* what;
  };
  // Packets in another order are missing where they were and found elsewhere: then "out of order" says it all.
  const Row rows[] = {{steps_back_, true, kOutOfOrder},
                      {missing_, steps_back_.count == 0, kMissing},
                      {snapped_, true, kSnapped},
                      {changed_, true, kChanged},
                      {silenced_, true, kSilenced},
                      {stampless_, true, kStampless},
                      {unnumbered_, numbered_ > 0, kNumberless}};
  std::vector<std::string> lines;
  for (const Row& row : rows) {
    if (row.tells && row.tally.count > 0) lines.push_back(row.tally.line(row.what));
  }
  return lines;
}

std::string LogAudit::why_unchecked() const {
  const char* without = undirected_.count > 0 ? "number (epb_packetid), some of them without direction (epb_flags): "
                                                "what was sent may count as received, and "
                                              : "number (epb_packetid): ";
  return unnumbered_.line(std::string("without a ") + without +
                          "whether packets are missing cannot be checked; an older version or another program wrote "
                          "it, the recording as it was written may tell");
}

LogFaults LogAudit::faults(const std::string& file, bool is_whole) const {
  LogFaults faults;
  const auto doubt = [&](const std::string& line) { faults.doubts.push_back(file + ": " + line); };
  for (const std::string& line : lacks()) doubt(line);
  faults.lacks_records = !faults.doubts.empty();
  faults.is_unchecked = numbered_ == 0 && is_ours_ && unnumbered_.count > 0 && !faults.lacks_records;
  if (faults.is_unchecked) doubt(why_unchecked());
  for (const auto& [interface, count] : foreign_) {
    doubt(counted(count, "packet") + " of another interface, " + interface + ", left out");
  }
  if (moved_s_ != 0.0) doubt(words_of_move(moved_s_));
  faults.lacks_end = is_whole && numbered_ > 0 && !has_end_;
  if (faults.lacks_end) doubt(kEndMissing);
  return faults;
}

}  // namespace deltamap::drivers::port
