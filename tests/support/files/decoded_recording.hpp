// SPDX-License-Identifier: Apache-2.0
// All that the devices say in a recording, by the drivers' own decoders.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "drivers/lms200/measurement.hpp"
#include "drivers/lms200/status.hpp"
#include "drivers/lms200/telegram.hpp"
#include "drivers/pioneer/config_packet.hpp"
#include "drivers/pioneer/extra_packets.hpp"
#include "drivers/pioneer/odometry.hpp"
#include "drivers/pioneer/packet.hpp"
#include "drivers/port/byte_log.hpp"

namespace deltamap::test {

namespace lms200 = drivers::lms200;
namespace pioneer = drivers::pioneer;

struct Decoded {
  std::vector<Scan> scans;
  std::vector<lms200::Measurement> measurements;
  std::vector<Odometry> odometry;
  std::vector<Pose2> sip_poses;  // as sent, not unwrapped
  std::vector<std::string> greeting;
  std::uint8_t measuring_mode = 0xFF;
  std::vector<Timestamp> stamps;
};

/// As a replay does it: the measuring mode from the laser's own replies.
inline Decoded decoded(const std::filesystem::path& recording) {
  Decoded all;
  drivers::port::ByteLogReader reader{recording};
  lms200::TelegramDecoder laser{lms200::Sender::kDevice, 500000};
  pioneer::PacketDecoder robot{500000};
  pioneer::OdometryTracker tracker{pioneer::model_named("p3dx-sh").value()};
  while (const auto record = reader.next()) {
    all.stamps.push_back(record->stamp);
    EXPECT_EQ(record->baud, 500000u);
    if (record->port == drivers::port::PortId::kRobot) {
      for (const auto& packet : robot.decode(record->bytes, record->stamp)) {
        if (const auto sip = pioneer::decoded_sip(packet.data)) {
          all.odometry.push_back(tracker.observe(*sip, packet.first_byte));
          all.sip_poses.push_back(
              {sip->x_units * 0.001, sip->y_units * 0.001, sip->heading_units * 2.0 * std::numbers::pi / 4096.0});
        } else if (const auto identity = pioneer::decoded_identity(packet.data)) {
          all.greeting.push_back("SYNC2 " + identity->subtype);
        } else if (const auto config = pioneer::decoded_config(packet.data)) {
          all.greeting.push_back("CONFIGpac " + config->subtype);
        }
      }
      continue;
    }
    for (const auto& telegram : laser.decode(record->bytes, record->stamp)) {
      if (const auto status = lms200::decoded_status(telegram)) {
        all.greeting.push_back("B1h " + std::to_string(status->scan_angle_deg) + "/" +
                               std::to_string(status->resolution_centideg));
      } else if (telegram.command == lms200::response::kConfiguration) {
        const auto configuration = lms200::configuration_with(telegram.data, {});
        all.measuring_mode = configuration.value().measuring_mode();
        all.greeting.push_back("F4h");
      } else if (auto measurement = lms200::decoded_measurement(telegram)) {
        const lms200::ScanFormat format{all.measuring_mode, 0.0, {}};
        all.scans.push_back(lms200::scan_from(*measurement, format, telegram.first_byte, telegram.received).value());
        all.measurements.push_back(std::move(*measurement));
      }
    }
  }
  EXPECT_FALSE(reader.cut());
  EXPECT_EQ(laser.counts().errors(), 0u);
  EXPECT_EQ(robot.counts().errors(), 0u);
  return all;
}

}  // namespace deltamap::test
