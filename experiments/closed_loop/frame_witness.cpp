// SPDX-License-Identifier: Apache-2.0
#include "experiments/closed_loop/frame_witness.hpp"

#include <algorithm>

#include "drivers/lms200/measurement.hpp"

namespace deltamap::experiments {
namespace {

namespace lms200 = drivers::lms200;
namespace pioneer = drivers::pioneer;

constexpr unsigned kWitnessBaud = 38400;  // times are of no meaning here
constexpr std::size_t kKeptScans = 200;   // more than may wait on a line

bool same_beams(const std::vector<Beam>& a, const std::vector<Beam>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const Beam& x, const Beam& y) { return x.kind == y.kind && x.range_m == y.range_m; });
}

}  // namespace

FrameWitness::FrameWitness(simulation::Simulation& devices, double max_range_m)
    : devices_{devices},
      max_range_m_{max_range_m},
      packets_{kWitnessBaud},
      telegrams_{lms200::Sender::kDevice, kWitnessBaud} {
  devices.robot().set_witness([this](std::span<const std::uint8_t> frame, Timestamp) {
    sent_.insert({frame.begin(), frame.end()});
  });
  devices.laser().set_witness([this](std::span<const std::uint8_t> frame, Timestamp now) {
    sent_.insert({frame.begin(), frame.end()});
    keep_scan(frame, now);
  });
}

void FrameWitness::keep_scan(std::span<const std::uint8_t> frame, Timestamp now) {
  lms200::TelegramDecoder decoder{lms200::Sender::kDevice, kWitnessBaud};
  for (const lms200::Telegram& telegram : decoder.decode(frame, now)) {
    const auto measurement = lms200::decoded_measurement(telegram);
    const auto coding = lms200::range_coding(devices_.laser().configuration().measuring_mode());
    if (!measurement || !coding) continue;
    std::vector<Beam> beams;
    for (const std::uint16_t word : measurement->words)
      beams.push_back(lms200::decoded_beam(word, *coding, measurement->metres_per_word(), max_range_m_));
    measured_.push_back(std::move(beams));
    if (measured_.size() > kKeptScans) measured_.pop_front();
  }
}

void FrameWitness::hear(std::span<const std::uint8_t> from_robot, std::span<const std::uint8_t> from_laser,
                        Timestamp now) {
  for (const pioneer::Packet& packet : packets_.decode(from_robot, now))
    wrong_frames_ += sent_.contains(pioneer::encoded_packet(packet.data)) ? 0 : 1;
  for (const lms200::Telegram& telegram : telegrams_.decode(from_laser, now)) {
    if (telegram.kind != lms200::Telegram::Kind::kTelegram) continue;
    const Frame frame = lms200::encoded_reply(telegram.command, telegram.data, telegram.status, telegram.address);
    wrong_frames_ += sent_.contains(frame) ? 0 : 1;
  }
}

void FrameWitness::judge(const Scan& scan) {
  const bool was_measured = std::any_of(measured_.begin(), measured_.end(),
                                        [&](const std::vector<Beam>& beams) { return same_beams(beams, scan.beams); });
  wrong_scans_ += was_measured ? 0 : 1;
}

}  // namespace deltamap::experiments
