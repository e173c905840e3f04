// SPDX-License-Identifier: Apache-2.0
// A session with a robot that says anything at any time.
#include "drivers/pioneer/session.hpp"
#include "tests/fuzz/input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace deltamap;
  drivers::pioneer::PioneerParams params;
  params.fast_baud = 38400;
  params.enable_motors = true;
  params.drive_switch = drivers::pioneer::DriveSwitch::kOn;
  drivers::pioneer::PioneerSession session{params, drivers::SessionMode::kLive};
  (void)session.start(timestamp_from_ns(1'700'000'000'000'000'000));
  fuzz::in_chunks({data, size}, [&](std::span<const std::uint8_t> chunk, Timestamp now) {
    const auto out = session.on_bytes(chunk, now);
    if (out.output.failed) (void)session.start(now);
    (void)session.drive({now, 0.3, 0.1}, now);
    (void)session.on_time(now);
  });
  return 0;
}
