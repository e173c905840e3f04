// SPDX-License-Identifier: Apache-2.0
// ARCOS packets from a robot, and commands from a host.
#include "drivers/pioneer/command.hpp"
#include "drivers/pioneer/packet.hpp"
#include "drivers/pioneer/receiver.hpp"
#include "tests/fuzz/input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace deltamap;
  drivers::pioneer::Receiver receiver{drivers::pioneer::PioneerParams{}};
  drivers::pioneer::PacketDecoder decoder{9600};
  fuzz::in_chunks({data, size}, [&](std::span<const std::uint8_t> chunk, Timestamp now) {
    for (const auto& packet : receiver.decode(chunk, now)) (void)receiver.take(packet);
    for (const auto& packet : decoder.decode(chunk, now)) (void)drivers::pioneer::decoded_command(packet.data);
  });
  (void)decoder.finish();
  return 0;
}
