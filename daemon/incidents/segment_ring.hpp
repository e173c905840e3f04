// SPDX-License-Identifier: Apache-2.0
// The newest minutes of both ports, on disk in segments of some seconds: an incident is cut from them. A segment begins
// at a checkpoint, so that a recording may begin with it; what is too old goes. Not synced to the disk: it need not
// outlive this process.
#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "daemon/records/checkpoint.hpp"
#include "daemon/records/run_so_far.hpp"
#include "drivers/port/byte_log.hpp"

namespace deltamap::daemon {

class SegmentRing {
 public:
  struct Segment {
    std::filesystem::path file;
    Timestamp began;
    RunSoFar so_far;                               ///< at its beginning
    std::shared_ptr<const Checkpoint> checkpoint;  ///< null: the run's first segment, which begins with its notes
  };
  /// Makes the folder, or empties it. `keep_s`: the oldest segment began at least so long ago, once the run has lasted
  /// as long. Throws std::runtime_error naming the folder.
  SegmentRing(std::filesystem::path folder, double keep_s);
  /// What it holds goes with it.
  ~SegmentRing();
  SegmentRing(const SegmentRing&) = delete;
  SegmentRing& operator=(const SegmentRing&) = delete;

  // All throw std::runtime_error naming the file where the disk is full or gone.

  /// From here on a recording may begin, with what is known. Segments that are too old go.
  void begin_segment(Timestamp now, const RunSoFar& so_far, std::shared_ptr<const Checkpoint> checkpoint);
  /// Into the newest segment.
  void write(const drivers::port::ByteRecord& record);
  /// The newest segment that began at this time or before, else the oldest.
  [[nodiscard]] const Segment& segment_at(Timestamp time) const;
  /// Every record from this segment's beginning on.
  void read_from(const Segment& segment, const std::function<void(const drivers::port::ByteRecord&)>& take);

  [[nodiscard]] bool is_empty() const { return segments_.empty(); }
  [[nodiscard]] const Segment& newest() const { return segments_.back(); }

 private:
  std::filesystem::path folder_;
  double keep_s_;
  std::uint64_t next_number_ = 0;
  std::deque<Segment> segments_;
  std::unique_ptr<drivers::port::ByteLogWriter> writer_;  // of the newest
};

}  // namespace deltamap::daemon
