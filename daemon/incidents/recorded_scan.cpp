// SPDX-License-Identifier: Apache-2.0
#include "daemon/incidents/recorded_scan.hpp"

#include <chrono>
#include <utility>

#include "daemon/records/recording_decoder.hpp"

namespace deltamap::daemon {

std::optional<Scan> recorded_scan(const Settings& settings, Timestamp time,
                                  const std::function<void(const TakeByteRecord&)>& records) {
  std::optional<Scan> nearest;
  const auto away = [&](const Scan& scan) { return std::chrono::abs(scan.time - time); };
  RecordingDecoder decoder{settings};
  const RecordingDecoder::Sinks sinks{.odometry = [](Odometry&&, std::uint32_t) {},
                                      .scan =
                                          [&](Scan&& scan) {
                                            if (!nearest || away(scan) <= away(*nearest)) nearest = std::move(scan);
                                          }};
  records([&](const drivers::port::ByteRecord& record) { decoder.feed(record, sinks); });
  return nearest;
}

}  // namespace deltamap::daemon
