// SPDX-License-Identifier: Apache-2.0
// The way to a stream alone, step by step, with a laser that is made of single answers.
#include "drivers/lms200/stream_setup.hpp"

#include <gtest/gtest.h>

#include "drivers/lms200/command.hpp"
#include "drivers/lms200/status.hpp"

namespace deltamap::drivers::lms200 {
namespace {

using Bytes = std::vector<std::uint8_t>;
using Result = StreamSetup::Result;

class StreamSetupTest : public testing::Test {
 protected:
  void search() {
    Transmitter line{receiver, now, out};
    setup.search(38400, line);
  }
  void hear(const Bytes& answer) {
    Transmitter line{receiver, now, out};
    for (const Telegram& telegram : receiver.decode(answer, now).telegrams) {
      (void)receiver.take(telegram);
      setup.answer(telegram, line);
    }
  }
  void hear_status_at(unsigned baud, const ScanVariant& variant) {
    DeviceStatus status;
    status.scan_angle_deg = variant.angle_deg;
    status.resolution_centideg = variant.resolution_centideg;
    status.baud_code = *baud_code(baud);
    hear(status_reply(status));
  }
  void time_out() {
    now = setup.deadline();
    Transmitter line{receiver, now, out};
    setup.time_out(line);
  }
  /// What was written since the last question.
  Bytes written() {
    Bytes bytes;
    for (const PortRequest& request : out.requests) {
      if (request.kind == PortRequest::Kind::kWrite)
        bytes.insert(bytes.end(), request.bytes.begin(), request.bytes.end());
    }
    out.requests.clear();
    return bytes;
  }

  Lms200Params params;
  Receiver receiver{params, SessionMode::kLive};
  StreamSetup setup{params};
  Timestamp now = timestamp_from_ns(1'700'000'000'000'000'000);
  SessionOutput out;
};

TEST_F(StreamSetupTest, StartsTheStreamOfALaserThatIsAsWanted) {
  search();
  EXPECT_EQ(written(), mode_request(mode::kOnRequest));
  time_out();
  EXPECT_EQ(written(), status_request());
  hear_status_at(38400, params.variant);
  EXPECT_EQ(written(), configuration_request());
  hear(configuration_reply(receiver.wanted_configuration()));
  EXPECT_EQ(written(), mode_request(mode::kStreamAll));
  EXPECT_EQ(setup.result(), Result::kPending);
  hear(mode_reply(true));
  EXPECT_EQ(setup.result(), Result::kStreams);
}

TEST_F(StreamSetupTest, BringsBaudThenVariantThenConfigurationToWhatIsWanted) {
  receiver.set_baud(9600);
  Transmitter line{receiver, now, out};
  setup.set_up_started(line);
  EXPECT_EQ(written(), status_request());
  hear_status_at(9600, {180, 100});
  EXPECT_EQ(written(), baud_request(38400));
  hear(mode_reply(true));
  EXPECT_EQ(receiver.baud(), 38400u);
  EXPECT_EQ(written(), Bytes{}) << "it settles";
  time_out();
  EXPECT_EQ(written(), status_request());
  hear_status_at(38400, {180, 100});
  EXPECT_EQ(written(), variant_request(params.variant));
  hear(variant_reply(true, params.variant));
  EXPECT_EQ(written(), configuration_request());
  Configuration in_centimetres;
  in_centimetres.set_units(Units::kCentimetre);
  hear(configuration_reply(in_centimetres));
  EXPECT_EQ(written(), installation_request());
  hear(mode_reply(true));
  Configuration wanted = in_centimetres;
  wanted.set_units(Units::kMillimetre);
  EXPECT_EQ(written(), write_configuration_request(wanted));
  hear(configuration_written_reply(true, wanted));
  EXPECT_EQ(written(), configuration_request()) << "verified";
  hear(configuration_reply(wanted));
  EXPECT_EQ(written(), mode_request(mode::kStreamAll));
}

TEST_F(StreamSetupTest, EndsWithNobodyOnceEverySpeedWasTried) {
  search();
  std::vector<unsigned> bauds;
  while (setup.result() == Result::kPending && bauds.size() < 100) {
    if (bauds.empty() || bauds.back() != receiver.baud()) bauds.push_back(receiver.baud());
    time_out();
  }
  EXPECT_EQ(setup.result(), Result::kNobodyAnswers);
  EXPECT_EQ(bauds, (std::vector<unsigned>{38400, 9600, 500000, 19200}));
}

TEST_F(StreamSetupTest, SaysWhenTheLaserStopsAnsweringInTheMiddle) {
  Transmitter line{receiver, now, out};
  hear_status_at(38400, params.variant);
  setup.set_up_known(line);
  int questions = 1;
  for (; setup.result() == Result::kPending && questions < 100; ++questions) time_out();
  EXPECT_EQ(setup.result(), Result::kStoppedAnswering);
  EXPECT_EQ(questions, 1 + 4);
}

}  // namespace
}  // namespace deltamap::drivers::lms200
