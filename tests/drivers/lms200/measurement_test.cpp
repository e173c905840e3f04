// SPDX-License-Identifier: Apache-2.0
#include "drivers/lms200/measurement.hpp"

#include <gtest/gtest.h>

#include "core/random.hpp"
#include "drivers/lms200/command.hpp"
#include "tests/support/bytes/damage.hpp"
#include "tests/support/bytes/hex.hpp"

namespace deltamap::drivers::lms200 {
namespace {

const Timestamp kStx = timestamp_from_ns(1'700'000'000'000'000'000);
const Timestamp kReceived = kStx + std::chrono::milliseconds{191};
constexpr double kTimeTolerance = 1e-7;
constexpr double kAngleTolerance = 1e-12;

Measurement measurement_of(std::size_t values, std::uint16_t word = 1500, std::uint8_t unit_code = 1) {
  Measurement measurement;
  measurement.words.assign(values, word);
  measurement.unit_code = unit_code;
  return measurement;
}

Scan scan_of(const Measurement& measurement, const ScanFormat& format = {}) {
  return scan_from(measurement, format, kStx, kReceived).value();
}

TEST(Measurement, ComesBackWithIndicesPartialsAndUnits) {
  Random random{4};
  for (const std::size_t values : {0u, 1u, 101u, 181u, 361u, 401u}) {
    Measurement measurement;
    for (std::size_t i = 0; i < values; ++i) {
      measurement.words.push_back(static_cast<std::uint16_t>(random.index_below(0x10000)));
    }
    measurement.unit_code = static_cast<std::uint8_t>(random.index_below(3));
    measurement.is_partial = random.index_below(2) == 1;
    measurement.partial_number = static_cast<std::uint8_t>(random.index_below(4));
    if (random.index_below(2) == 1) measurement.indices = Measurement::Indices{7, 255};
    measurement.status = 0x13;
    TelegramDecoder decoder{Sender::kDevice, 500000};
    const auto telegrams = decoder.decode(encoded_measurement(measurement), kStx);
    ASSERT_EQ(telegrams.size(), 1u);
    EXPECT_EQ(decoded_measurement(telegrams[0]), measurement);
  }
}

TEST(Measurement, IsRefusedWhereCountAndLengthDisagree) {
  for (const char* data : {"", "05", "0540 e803", "0040 e803e8", "01c0 e803"}) {
    Telegram telegram;
    telegram.command = response::kScan;
    telegram.data = tests::bytes_from_hex(data);
    EXPECT_FALSE(decoded_measurement(telegram)) << data;
  }
}

TEST(ScanFromMeasurement, PointsItsBeamsCounterClockwiseAroundStraightAhead) {
  const Scan wide = scan_of(measurement_of(361));
  EXPECT_NEAR(wide.bearing_rad(0), radians(-90.0), kAngleTolerance);
  EXPECT_NEAR(wide.bearing_rad(180), 0.0, kAngleTolerance);
  EXPECT_NEAR(wide.bearing_rad(360), radians(90.0), kAngleTolerance);
  const Scan narrow = scan_of(measurement_of(401));
  EXPECT_NEAR(narrow.bearing_rad(0), radians(-50.0), kAngleTolerance);
  EXPECT_NEAR(narrow.bearing_rad(400), radians(50.0), kAngleTolerance);
}

TEST(ScanFromMeasurement, PointsItsBeamsAsTheLaserHasToldItsVariant) {
  const auto bearings_deg = [](unsigned values, const ScanVariant& told) {
    const Scan scan = scan_of(measurement_of(values), {.variant = told});
    return std::pair{degrees(scan.bearing_rad(0)), degrees(scan.bearing_rad(values - 1))};
  };
  const auto expect = [&](unsigned values, const ScanVariant& told, double half_deg) {
    const auto [first_deg, last_deg] = bearings_deg(values, told);
    EXPECT_NEAR(first_deg, -half_deg, 1e-9) << name_of(told);
    EXPECT_NEAR(last_deg, half_deg, 1e-9) << name_of(told);
  };
  expect(181, {90, 50}, 45.0);
  expect(181, {180, 100}, 90.0);
  expect(401, {100, 25}, 50.0);
  expect(361, {90, 50}, 90.0);  // of other values: by their number
}

TEST(ScanFromMeasurement, TurnsTheScanOfALaserThatHangsUpsideDown) {
  for (const unsigned values : {101u, 181u, 361u, 401u}) {
    Measurement measurement = measurement_of(values);
    measurement.words[10] = 700;  // the eleventh from its own right, which is the robot's left
    const Scan upright = scan_of(measurement);
    const Scan hanging = scan_of(measurement, {.is_upside_down = true});
    ASSERT_EQ(hanging.beams.size(), values);
    for (unsigned i = 0; i < values; ++i) {
      EXPECT_EQ(hanging.beams[i].range_m, upright.beams[values - 1 - i].range_m);
      EXPECT_EQ(hanging.beams[i].offset_s, upright.beams[values - 1 - i].offset_s) << "its own time";
      EXPECT_NEAR(hanging.bearing_rad(i), -upright.bearing_rad(values - 1 - i), kAngleTolerance);
    }
  }
}

TEST(ScanFromMeasurement, DatesTheScanBackByItsDuration) {
  const auto expect_duration = [](std::size_t values, double duration_s) {
    const Scan scan = scan_of(measurement_of(values));
    EXPECT_NEAR(seconds(kStx - scan.time), duration_s, kTimeTolerance) << values;
    EXPECT_EQ(scan.received, kReceived);
  };
  expect_duration(181, 0.01332);
  expect_duration(361, 0.02664);
  expect_duration(101, 0.01332);
  expect_duration(201, 0.02664);
  expect_duration(401, 0.05328);
}

TEST(ScanFromMeasurement, GivesEachBeamTheTimeOfItsRaster) {
  const Scan scan = scan_of(measurement_of(361));
  EXPECT_NEAR(scan.beams[0].offset_s, 0.0, kTimeTolerance);
  EXPECT_NEAR(scan.beams[180].offset_s, 0.01332 * 90 / 360, kTimeTolerance) << "even: first turn";
  EXPECT_NEAR(scan.beams[181].offset_s, 0.01332 + 0.01332 * 90.5 / 360, kTimeTolerance) << "odd: second turn";
  const Scan fine = scan_of(measurement_of(401));
  EXPECT_NEAR(fine.beams[0].offset_s, 0.01332 * 40 / 360, kTimeTolerance);
  EXPECT_NEAR(fine.beams[3].offset_s, 3 * 0.01332 + 0.01332 * 40.75 / 360, kTimeTolerance);
  EXPECT_NEAR(fine.beams[3].offset_s, beam_offset_s({100, 25}, 3), kTimeTolerance);
}

TEST(ScanFromMeasurement, PlacesTheRastersOfInterlacedScans) {
  Measurement measurement = measurement_of(180);
  measurement.is_partial = true;
  measurement.partial_number = 1;
  const Scan scan = scan_of(measurement);
  EXPECT_NEAR(scan.bearing_rad(0), radians(-89.75), kAngleTolerance);
  EXPECT_NEAR(scan.bearing_step_rad, radians(1.0), kAngleTolerance);
  EXPECT_NEAR(seconds(kStx - scan.time), 0.01332, kTimeTolerance);
  measurement.words.pop_back();
  EXPECT_FALSE(scan_from(measurement, {}, kStx, kReceived));
}

TEST(ScanFromMeasurement, MasksByTheMeasuringModeAndNotByTheUnits) {
  constexpr std::uint16_t kNineMetresWithFlag = 9000 | 0x8000;
  const Scan far = scan_of(measurement_of(181, kNineMetresWithFlag), {.measuring_mode = 0x06});
  EXPECT_EQ(far.beams[0].kind, BeamKind::kRange);
  EXPECT_FLOAT_EQ(far.beams[0].range_m, 9.0F);
  constexpr std::uint16_t kTwoMetresWithFieldBits = 2000 | 0xE000;
  const Scan near = scan_of(measurement_of(181, kTwoMetresWithFieldBits), {.measuring_mode = 0x00});
  EXPECT_FLOAT_EQ(near.beams[0].range_m, 2.0F);
  EXPECT_FALSE(scan_from(measurement_of(181), {.measuring_mode = 0x3F}, kStx, kReceived)) << "reflectivity only";
}

TEST(ScanFromMeasurement, TellsTheKindsOfBeamsApartInEveryMode) {
  for (const int mode : {0, 1, 2, 3, 4, 5, 6, 0x0F}) {
    const auto measuring_mode = static_cast<std::uint8_t>(mode);
    const RangeCoding coding = *range_coding(measuring_mode);
    Measurement measurement = measurement_of(181);
    const auto code = [&](unsigned low) { return static_cast<std::uint16_t>(coding.beyond_maximum - 0xF7 + low); };
    measurement.words[0] = code(0xFF);
    measurement.words[1] = code(0xFE);
    measurement.words[2] = code(0xF7);
    measurement.words[3] = code(0xFB);
    measurement.words[4] = code(0xF6);
    measurement.words[5] = 0;
    const Scan scan = scan_of(measurement, {.measuring_mode = measuring_mode});
    EXPECT_EQ(scan.beams[0].kind, BeamKind::kNotValid);
    EXPECT_EQ(scan.beams[1].kind, BeamKind::kDazzled);
    EXPECT_EQ(scan.beams[2].kind, BeamKind::kBeyondMaximum);
    EXPECT_EQ(scan.beams[3].kind, BeamKind::kOther);
    EXPECT_EQ(scan.beams[4].kind, BeamKind::kRange) << "the longest range";
    EXPECT_EQ(scan.beams[5].kind, BeamKind::kNotValid) << "no surface is at the lens";
    for (int i = 0; i < 4; ++i) EXPECT_EQ(scan.beams[static_cast<std::size_t>(i)].range_m, 0.0F);
  }
}

TEST(ScanFromMeasurement, ReadsCentimetresAndMillimetres) {
  EXPECT_FLOAT_EQ(scan_of(measurement_of(181, 1500, 0)).beams[7].range_m, 15.0F);
  EXPECT_FLOAT_EQ(scan_of(measurement_of(181, 1500, 1)).beams[7].range_m, 1.5F);
  EXPECT_NEAR(scan_of(measurement_of(181, 1500, 0)).max_range_m, 81.83, 1e-9);
  EXPECT_NEAR(scan_of(measurement_of(181, 1500, 1)).max_range_m, 8.183, 1e-9);
}

TEST(ScanFromMeasurement, TakesRangesOverTheConfiguredMaximumAsBeyondIt) {
  Measurement measurement = measurement_of(181, 3000, 0);
  measurement.words[1] = 3001;
  const Scan scan = scan_of(measurement, {.max_range_m = 30.0});
  EXPECT_EQ(scan.beams[0].kind, BeamKind::kRange);
  EXPECT_EQ(scan.beams[1].kind, BeamKind::kBeyondMaximum);
  EXPECT_EQ(scan.max_range_m, 30.0);
  for (std::uint16_t word = 1; word < 8000; word = static_cast<std::uint16_t>(word + 7)) {
    const Scan at_maximum = scan_of(measurement_of(181, word, 0), {.max_range_m = word / 100.0});
    ASSERT_EQ(at_maximum.beams[0].kind, BeamKind::kRange) << word << " cm is not beyond itself";
  }
}

TEST(ScanFromMeasurement, CarriesTheMount) {
  const Pose2 mount{0.25, 0.01, -0.02};
  EXPECT_EQ(scan_of(measurement_of(181), {.robot_from_laser = mount}).robot_from_laser, mount);
}

TEST(ScanFromMeasurement, CarriesSeverityAndPlausibilityOfTheStatusByte) {
  struct Case {
    std::uint8_t status;
    unsigned severity;
    bool implausible;
  };
  for (const Case& c : {Case{kNormalStatus, 0, false}, Case{0x12, 2, false}, Case{0x14, 4, false}, Case{0x50, 0, true},
                        Case{0x54, 4, true}, Case{0xB0, 0, false}, Case{0xFB, 3, true}}) {
    Measurement measurement = measurement_of(181);
    measurement.status = c.status;
    const Scan scan = scan_of(measurement);
    EXPECT_EQ(scan.severity, c.severity) << int{c.status};
    EXPECT_EQ(scan.implausible, c.implausible) << int{c.status};
  }
}

TEST(EncodedBeam, ComesBackThroughTheCodec) {
  for (const int mode : {0, 3, 6}) {
    const auto measuring_mode = static_cast<std::uint8_t>(mode);
    const RangeCoding coding = *range_coding(measuring_mode);
    for (const BeamKind kind : {BeamKind::kBeyondMaximum, BeamKind::kNotValid, BeamKind::kDazzled, BeamKind::kOther}) {
      const Beam back = decoded_beam(encoded_beam({.kind = kind}, coding, 0.001), coding, 0.001, 100.0);
      EXPECT_EQ(back.kind, kind);
    }
    const Beam range{.range_m = 1.2344F, .kind = BeamKind::kRange};
    EXPECT_EQ(encoded_beam(range, coding, 0.001), 1234);
    EXPECT_EQ(encoded_beam(range, coding, 0.01), 123);
    const Beam too_far{.range_m = 500.0F, .kind = BeamKind::kRange};
    EXPECT_EQ(decoded_beam(encoded_beam(too_far, coding, 0.01), coding, 0.01, 1e3).kind, BeamKind::kBeyondMaximum);
  }
}

TEST(ScanFromMeasurement, SurvivesRandomTelegrams) {
  Random random{21};
  for (int i = 0; i < 20'000; ++i) {
    Telegram telegram;
    telegram.command = response::kScan;
    telegram.data = tests::random_bytes(random.index_below(40), random);
    const auto measurement = decoded_measurement(telegram);
    if (measurement) (void)scan_from(*measurement, {}, kStx, kReceived);
  }
}

}  // namespace
}  // namespace deltamap::drivers::lms200
