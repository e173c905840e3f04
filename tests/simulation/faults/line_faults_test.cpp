// SPDX-License-Identifier: Apache-2.0
// What goes wrong on a line and with a laser's conversation, as the sessions of the real devices see it.
#include "simulation/devices/line_faults.hpp"

#include <gtest/gtest.h>

#include "tests/simulation/simulation_host.hpp"

namespace deltamap::simulation {
namespace {

constexpr double kLineConnecting_s = 12.0;

struct LineDrive {
  LineDrive() : host{delivered("room"), 3} { host.run_for(kLineConnecting_s); }

  /// Those that came meanwhile.
  std::size_t scans_in(double seconds) {
    const std::size_t before = host.scans.size();
    host.run_for(seconds);
    return host.scans.size() - before;
  }
  Faults& faults() { return host.simulation.faults(); }

  Host host;
};

TEST(LineFaults, CarryNothingOneWayOrBoth) {
  LineDrive drive;
  const auto heard = [&](devices::LineFaults line) {
    drive.faults().laser_line = line;
    drive.host.run_for(1.0);
    return drive.scans_in(1.0) > 0;
  };
  EXPECT_TRUE(heard({}));
  EXPECT_FALSE(heard({.is_cut = true}));
  EXPECT_FALSE(heard({.is_mute = true}));
  EXPECT_TRUE(heard({.is_deaf = true})) << "it streams on";
  EXPECT_FALSE(heard({.is_unplugged = true}));
  EXPECT_FALSE(drive.host.simulation.has_laser_port());
}

TEST(LineFaults, DamageWhatTheDeviceSends) {
  for (const devices::LineFaults line : {devices::LineFaults{.flipped_share = 1.0}, {.truncated_share = 1.0}}) {
    LineDrive drive;
    drive.faults().laser_line = line;
    drive.host.run_for(0.5);
    EXPECT_EQ(drive.scans_in(2.0), 0u);
    EXPECT_GT(drive.host.laser_session.counts().garbage_bytes + drive.host.laser_session.counts().bad_checksum, 0u);
  }
  LineDrive drive;
  drive.faults().laser_line = {.noisy_share = 1.0};
  drive.host.run_for(0.5);
  const auto garbage_before = drive.host.laser_session.counts().garbage_bytes;
  EXPECT_GT(drive.scans_in(2.0), 0u) << "what is whole between noise is heard";
  EXPECT_GT(drive.host.laser_session.counts().garbage_bytes, garbage_before);
}

TEST(LineFaults, SpeakAtABaudOfTheirOwn) {
  LineDrive drive;
  drive.faults().laser_line.baud = 19200;
  drive.host.run_for(20.0);
  EXPECT_EQ(drive.host.laser_session.baud(), 19200u);
  EXPECT_GT(drive.scans_in(2.0), 0u);
}

TEST(LaserUnitFaults, LosesItsAcksAndRefusesByNak) {
  LineDrive drive;
  drive.faults().laser_unit.sends_no_acks = true;
  drive.host.restart_sessions();
  drive.host.run_for(kLineConnecting_s);
  EXPECT_TRUE(drive.host.laser_session.is_streaming());
  drive.faults().laser_unit = {.sends_naks = true};
  drive.host.restart_sessions();
  drive.host.run_for(kLineConnecting_s);
  EXPECT_FALSE(drive.host.laser_session.is_streaming());
  drive.faults() = {};
  drive.host.run_for(kLineConnecting_s);
  EXPECT_TRUE(drive.host.laser_session.is_streaming());
}

TEST(LaserUnitFaults, CutsItsPowerForAMoment) {
  LineDrive drive;
  ++drive.faults().laser_unit.restarts;
  drive.faults().laser_unit.start_up_s = 4.0;
  drive.host.run_for(0.5);
  EXPECT_EQ(drive.scans_in(3.0), 0u);
  drive.host.run_for(3.0);
  EXPECT_GT(drive.scans_in(2.0), 0u);
}

}  // namespace
}  // namespace deltamap::simulation
