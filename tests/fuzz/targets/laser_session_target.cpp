// SPDX-License-Identifier: Apache-2.0
// A session with a laser that says anything at any time.
#include "drivers/lms200/session.hpp"
#include "tests/fuzz/input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace deltamap;
  drivers::lms200::Lms200Session session{drivers::lms200::Lms200Params{}, drivers::SessionMode::kLive};
  (void)session.start(timestamp_from_ns(1'700'000'000'000'000'000));
  fuzz::in_chunks({data, size}, [&](std::span<const std::uint8_t> chunk, Timestamp now) {
    const auto out = session.on_bytes(chunk, now);
    if (out.output.failed) (void)session.start(now);
    (void)session.on_time(now);
  });
  return 0;
}
