// SPDX-License-Identifier: Apache-2.0
// Lines to the daemon's control socket.
#include "daemon/control/request.hpp"
#include "tests/fuzz/input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace deltamap;
  const auto answer = daemon::control::request_of_line(fuzz::text_of({data, size}));
  if (answer.request) (void)daemon::control::request_of_line(daemon::control::line_of(*answer.request));
  (void)daemon::control::is_stop(fuzz::text_of({data, size}));
  return 0;
}
