// SPDX-License-Identifier: Apache-2.0
// Each limit goes into its own command and is read from its own field: no other one stands for it.
#include "drivers/pioneer/motion_limits.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

namespace deltamap::drivers::pioneer {
namespace {

/// No two are the same number on the wire.
constexpr MotionLimits kLimits{.max_speed_m_per_s = 0.41,
                               .max_turn_rate_rad_per_s = radians(52.0),
                               .acceleration_m_per_s2 = 0.31,
                               .deceleration_m_per_s2 = 0.92,
                               .turn_acceleration_rad_per_s2 = radians(103.0),
                               .turn_deceleration_rad_per_s2 = radians(154.0)};

ConfigPacket reporting_them() {
  ConfigPacket config;
  config.watchdog_ms = 700;
  config.trans_vel_max = 410;
  config.rot_vel_max = 52;
  config.trans_acc = 310;
  config.trans_decel = 920;
  config.rot_acc = 103;
  config.rot_decel = 154;
  return config;
}

TEST(MotionLimits, AreEachSetByACommandOfItsOwn) {
  EXPECT_EQ(limit_commands(kLimits), (std::vector<Command>{{CommandNumber::kSetV, 410},
                                                           {CommandNumber::kSetRv, 52},
                                                           {CommandNumber::kSetA, 310},
                                                           {CommandNumber::kSetA, -920},
                                                           {CommandNumber::kSetRa, 103},
                                                           {CommandNumber::kSetRa, -154}}));
}

TEST(MotionLimits, ShowOnlyWhereTheControllerReportsEveryOne) {
  EXPECT_TRUE(shows(reporting_them(), kLimits));
  for (std::uint16_t ConfigPacket::*field :
       {&ConfigPacket::trans_vel_max, &ConfigPacket::rot_vel_max, &ConfigPacket::trans_acc, &ConfigPacket::trans_decel,
        &ConfigPacket::rot_acc, &ConfigPacket::rot_decel}) {
    ConfigPacket config = reporting_them();
    ++(config.*field);
    EXPECT_FALSE(shows(config, kLimits));
  }
  ConfigPacket config = reporting_them();
  config.watchdog_ms.reset();
  EXPECT_FALSE(shows(config, kLimits)) << "an old controller that does not tell its watchdog";
}

TEST(StoppingLimits, AreThoseOfBrakingAndNotOfGatheringSpeed) {
  const StoppingLimits limits = stopping_limits_of(reporting_them());
  EXPECT_DOUBLE_EQ(limits.watchdog_s.value_or(0.0), 0.7);
  EXPECT_DOUBLE_EQ(limits.deceleration_m_per_s2, 0.92);
  EXPECT_DOUBLE_EQ(limits.turn_deceleration_rad_per_s2, radians(154.0));
}

TEST(StoppingLimits, AreAsDeliveredUntilTheControllerTellsItsOwn) {
  for (const auto& told : {std::optional<ConfigPacket>{}, std::optional{ConfigPacket{}}}) {
    std::optional<ConfigPacket> config = told;
    if (config) {
      config->watchdog_ms.reset();
      config->trans_decel = config->rot_decel = 0;
    }
    const StoppingLimits limits = stopping_limits_of(config);
    EXPECT_FALSE(limits.watchdog_s);
    EXPECT_DOUBLE_EQ(limits.deceleration_m_per_s2, 0.3);
    EXPECT_DOUBLE_EQ(limits.turn_deceleration_rad_per_s2, radians(100.0));
  }
  ConfigPacket without_watchdog = reporting_them();
  without_watchdog.watchdog_ms = 0;
  EXPECT_TRUE(std::isinf(*stopping_limits_of(without_watchdog).watchdog_s)) << "it never stops by itself";
}

}  // namespace
}  // namespace deltamap::drivers::pioneer
