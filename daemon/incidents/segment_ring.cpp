// SPDX-License-Identifier: Apache-2.0
#include "daemon/incidents/segment_ring.hpp"

#include <charconv>
#include <stdexcept>
#include <system_error>
#include <utility>

namespace deltamap::daemon {

namespace fs = std::filesystem;

SegmentRing::SegmentRing(fs::path folder, double keep_s) : folder_{std::move(folder)}, keep_s_{keep_s} {
  std::error_code error;
  fs::remove_all(folder_, error);
  fs::create_directories(folder_, error);
  if (error) throw std::runtime_error(folder_.string() + ": cannot be made: " + error.message());
}

void SegmentRing::remove() {
  std::error_code ignored;
  writer_.reset();
  fs::remove_all(folder_, ignored);
}

void SegmentRing::begin_segment(Timestamp now, const RunSoFar& so_far, std::shared_ptr<const Checkpoint> checkpoint,
                                const std::vector<drivers::port::ByteRecord>& beginning) {
  drivers::port::ByteLogWriter first{folder_ / name_of_beginning(next_number_), so_far.bauds()};
  for (const drivers::port::ByteRecord& record : beginning) first.write(record);
  first.close();
  auto next = std::make_unique<drivers::port::ByteLogWriter>(folder_ / name_of(next_number_), so_far.bauds());
  if (writer_) writer_->close();
  writer_ = std::move(next);
  segments_.push_back({next_number_++, now, so_far, std::move(checkpoint)});
  while (segments_.size() > 1 && seconds(now - segments_[1].began) >= keep_s_) {
    std::error_code ignored;
    fs::remove(folder_ / name_of_beginning(segments_.front().number), ignored);
    fs::remove(folder_ / name_of(segments_.front().number), ignored);
    segments_.pop_front();
  }
}

std::optional<std::uint64_t> SegmentRing::number_of(const std::string& name) {
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  if (error != std::errc{} || name != name_of(number)) return std::nullopt;
  return number;
}

void SegmentRing::write(const drivers::port::ByteRecord& record) {
  if (!writer_) throw std::runtime_error(folder_.string() + ": no segment has been begun");
  writer_->write(record);
}

void SegmentRing::flush() {
  if (writer_) writer_->flush();
}

const SegmentRing::Segment& SegmentRing::segment_at(Timestamp time) const {
  if (segments_.empty()) throw std::runtime_error(folder_.string() + ": holds nothing yet");
  const Segment* found = &segments_.front();
  for (const Segment& segment : segments_) {
    if (segment.began <= time) found = &segment;
  }
  return *found;
}

void SegmentRing::read_from(const Segment& segment, const std::function<void(const drivers::port::ByteRecord&)>& take) {
  flush();
  bool is_wanted = false;
  for (const Segment& one : segments_) {
    is_wanted = is_wanted || &one == &segment;
    if (!is_wanted) continue;
    drivers::port::ByteLogReader reader{folder_ / name_of(one.number)};
    while (const auto record = reader.next()) take(*record);
  }
}

}  // namespace deltamap::daemon
