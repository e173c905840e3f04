// SPDX-License-Identifier: Apache-2.0
#include "drivers/port/log_audit.hpp"

#include <cstdio>

namespace deltamap::drivers::port {

std::string LogAudit::Tally::line(const std::string& what) const {
  return std::to_string(count) + (count == 1 ? " packet " : " packets ") + what + " (the first at byte " +
         std::to_string(first_byte) + ")";
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

LogFaults LogAudit::faults(const std::string& file, bool is_whole) const {
  LogFaults faults;
  const auto doubt = [&](const std::string& line) { faults.doubts.push_back(file + ": " + line); };
  const auto lack = [&](const Tally& tally, const std::string& what) {
    if (tally.count == 0) return;
    doubt(tally.line(what));
    faults.lacks_records = true;
  };
  lack(steps_back_,
       "out of order: recordings were joined, packets doubled or put in another order; give one recording in the order "
       "in which it was written");
  // Packets in another order are missing where they were and found elsewhere: then "out of order" says it all.
  if (steps_back_.count == 0)
    lack(missing_,
         "missing before later ones: another program took them out, or the disk was full; the recording as it was "
         "written has them");
  lack(snapped_, "cut by a snap length, and left out; the recording as it was written has them whole");
  lack(
      changed_,
      "changed since they were written, by another program or by damage, and left out; the recording as it was written "
      "has them");
  lack(silenced_, "without the note that they were written for: another program took it out");
  lack(stampless_, "without a time (simple or obsolete packet blocks), and left out");
  if (numbered_ > 0) {
    lack(unnumbered_, "without a number: another program has added or changed them");
  } else if (is_ours_ && unnumbered_.count > 0 && !faults.lacks_records) {
    const char* without = undirected_.count > 0 ? "number (epb_packetid), some of them without direction (epb_flags): "
                                                  "what was sent may count as received, and "
                                                : "number (epb_packetid): ";
    doubt(unnumbered_.line(std::string("without a ") + without +
                           "whether packets are missing cannot be checked; an older version or another program wrote "
                           "it, the recording as it was written may tell"));
    faults.is_unchecked = true;
  }
  for (const auto& [interface, count] : foreign_) {
    doubt(std::to_string(count) + " packets of another interface, " + interface + ", left out");
  }
  if (moved_s_ != 0.0) {
    char text[128];
    (void)std::snprintf(text, sizeof text,
                        "its times were moved by %+.9g s after it was written; its notes tell the old ones", moved_s_);
    doubt(text);
  }
  faults.lacks_end = is_whole && numbered_ > 0 && !has_end_;
  if (faults.lacks_end) {
    doubt(
        "its end is missing: whoever wrote it was ended, is still writing or has reached recording.max_gigabytes, or "
        "another program has cut the end off");
  }
  return faults;
}

}  // namespace deltamap::drivers::port
