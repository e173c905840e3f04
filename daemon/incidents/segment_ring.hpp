// SPDX-License-Identifier: Apache-2.0
// The newest minutes of both ports, on disk in segments of some seconds: an incident is cut from them. A segment begins
// at a checkpoint, so that a recording may begin with it; what is too old goes. It outlives a process that is killed:
// then the next one finds it (daemon/incidents/left_ring). Each segment is synced to the disk when the next one begins.
#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "daemon/records/checkpoint.hpp"
#include "daemon/records/run_so_far.hpp"
#include "drivers/port/byte_log.hpp"

namespace deltamap::daemon {

/// In the folder of the incidents.
inline constexpr const char* kRingFolder = ".ring";

class SegmentRing {
 public:
  struct Segment {
    std::uint64_t number = 0;
    Timestamp began;
    RunSoFar so_far;                               ///< at its beginning
    std::shared_ptr<const Checkpoint> checkpoint;  ///< null: the run's first segment, which begins with its notes
  };
  /// Makes the folder, or empties it. `keep_s`: the oldest segment began at least so long ago, once the run has lasted
  /// as long. Throws std::runtime_error naming the folder.
  SegmentRing(std::filesystem::path folder, double keep_s);

  /// The run has ended as it should: nothing of it is left.
  void remove();

  // All throw std::runtime_error naming the file where the disk is full or gone.

  /// From here on a recording may begin, with what is known. `beginning`: what a later process must know for that; it
  /// stands in a file of its own beside the segment's. Segments that are too old go.
  void begin_segment(Timestamp now, const RunSoFar& so_far, std::shared_ptr<const Checkpoint> checkpoint,
                     const std::vector<drivers::port::ByteRecord>& beginning);
  /// Into the newest segment.
  void write(const drivers::port::ByteRecord& record);
  /// Hands it to the kernel: a killed process loses nothing from before.
  void flush();
  /// The newest segment that began at this time or before, else the oldest.
  [[nodiscard]] const Segment& segment_at(Timestamp time) const;
  /// Every record from this segment's beginning on.
  void read_from(const Segment& segment, const std::function<void(const drivers::port::ByteRecord&)>& take);

  [[nodiscard]] bool is_empty() const { return segments_.empty(); }
  [[nodiscard]] const Segment& oldest() const { return segments_.front(); }
  [[nodiscard]] const Segment& newest() const { return segments_.back(); }
  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

  /// The files of a segment, and the number of a segment whose bytes a file of that name holds.
  [[nodiscard]] static std::string name_of(std::uint64_t number) { return std::to_string(number) + ".pcapng"; }
  [[nodiscard]] static std::string name_of_beginning(std::uint64_t number) {
    return std::to_string(number) + ".begin.pcapng";
  }
  [[nodiscard]] static std::optional<std::uint64_t> number_of(const std::string& name);

 private:
  std::filesystem::path folder_;
  double keep_s_;
  std::uint64_t next_number_ = 0;
  std::deque<Segment> segments_;
  std::unique_ptr<drivers::port::ByteLogWriter> writer_;  // of the newest
};

}  // namespace deltamap::daemon
