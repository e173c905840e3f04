// SPDX-License-Identifier: Apache-2.0
// LMS200 telegrams from a laser, and requests from a host.
#include "drivers/lms200/command.hpp"
#include "drivers/lms200/receiver.hpp"
#include "drivers/lms200/telegram.hpp"
#include "drivers/lms200/value_selection.hpp"
#include "tests/fuzz/input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace deltamap;
  drivers::lms200::Receiver receiver{drivers::lms200::Lms200Params{}, drivers::SessionMode::kListenOnly};
  drivers::lms200::TelegramDecoder requests{drivers::lms200::Sender::kHost, 9600};
  fuzz::in_chunks({data, size}, [&](std::span<const std::uint8_t> chunk, Timestamp now) {
    for (const auto& telegram : receiver.decode(chunk, now).telegrams) (void)receiver.take(telegram);
    for (const auto& telegram : requests.decode(chunk, now)) {
      (void)drivers::lms200::requested_variant(telegram);
      (void)drivers::lms200::requested_selection(telegram);
    }
  });
  (void)requests.finish();
  return 0;
}
