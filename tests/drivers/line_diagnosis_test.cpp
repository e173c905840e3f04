// SPDX-License-Identifier: Apache-2.0
#include "drivers/line_diagnosis.hpp"

#include <gtest/gtest.h>

#include "core/random.hpp"
#include "drivers/lms200/command.hpp"
#include "drivers/pioneer/packet.hpp"
#include "tests/support/bytes/damage.hpp"

namespace deltamap::drivers {
namespace {

const std::vector<std::uint8_t> kFromLaser = lms200::type_reply("LMS200;301063;V02.30 ");
const std::vector<std::uint8_t> kFromRobot =
    pioneer::encoded_packet(std::vector<std::uint8_t>{0x32, 1, 2, 3, 4, 5, 6, 7, 8, 9, 0xFA});

LineDiagnosis after(Device expected, const std::vector<std::uint8_t>& bytes, std::size_t chunk) {
  LineDiagnosis diagnosis{expected};
  for (std::size_t i = 0; i < bytes.size(); i += chunk) {
    diagnosis.hear(std::span{bytes}.subspan(i, std::min(chunk, bytes.size() - i)));
  }
  return diagnosis;
}

TEST(LineDiagnosis, TellsSilenceGarbageAndSwappedPortsApart) {
  EXPECT_TRUE(LineDiagnosis{Device::kRobot}.phrase().starts_with("no bytes came"));
  EXPECT_TRUE(after(Device::kRobot, {0x80, 0x02}, 1).phrase().starts_with("garbage came"));
  EXPECT_EQ(after(Device::kRobot, kFromLaser, 64).phrase(),
            "the ports are swapped: the laser speaks on the robot's port");
  EXPECT_EQ(after(Device::kLaser, kFromRobot, 64).phrase(),
            "the ports are swapped: the robot speaks on the laser's port");
}

TEST(LineDiagnosis, DoesNotTakeADeviceForTheOther) {
  EXPECT_FALSE(after(Device::kRobot, kFromRobot, 64).is_swapped());
  EXPECT_FALSE(after(Device::kLaser, kFromLaser, 64).is_swapped());
}

TEST(LineDiagnosis, FindsTheOtherDeviceBetweenNoiseHoweverTheStreamIsCut) {
  Random random{9};
  for (const Device expected : {Device::kRobot, Device::kLaser}) {
    const auto& frame = expected == Device::kRobot ? kFromLaser : kFromRobot;
    for (std::size_t chunk = 1; chunk < 40; ++chunk) {
      auto stream = tests::random_bytes(50 + chunk, random);
      stream.push_back(frame[0]);  // a header that leads nowhere
      stream.insert(stream.end(), frame.begin(), frame.end());
      EXPECT_TRUE(after(expected, stream, chunk).is_swapped()) << chunk;
    }
  }
}

TEST(LineDiagnosis, NeverBelievesADamagedFrameOrRandomBytes) {
  for (const Device expected : {Device::kRobot, Device::kLaser}) {
    const auto& frame = expected == Device::kRobot ? kFromLaser : kFromRobot;
    for (const auto& flipped : tests::every_flipped_bit(frame)) {
      EXPECT_FALSE(after(expected, flipped, 64).is_swapped());
    }
    Random random{1};
    EXPECT_FALSE(after(expected, tests::random_bytes(1'000'000, random), 512).is_swapped());
  }
}

TEST(LineDiagnosis, DoesNotCallADeviceAbsentThatWasHeard) {
  LineDiagnosis diagnosis{Device::kRobot};
  diagnosis.hear_own_frame();
  EXPECT_TRUE(diagnosis.phrase().starts_with("it was heard"));
}

TEST(LineDiagnosis, BeginsAnewWithEachSearch) {
  LineDiagnosis diagnosis = after(Device::kRobot, kFromLaser, 64);
  diagnosis.reset();
  EXPECT_TRUE(diagnosis.phrase().starts_with("no bytes came"));
}

TEST(LineDiagnosis, AsksALaserWithARequestThatItUnderstands) {
  EXPECT_EQ(LineDiagnosis::question_to_a_laser(), lms200::type_request());
}

}  // namespace
}  // namespace deltamap::drivers
