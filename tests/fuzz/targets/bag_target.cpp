// SPDX-License-Identifier: Apache-2.0
// ROS 1 bags and the messages in them, taken for what their types say and for what they do not.
#include "tests/fuzz/input.hpp"
#include "tool/import/message_file.hpp"
#include "tool/import/ros_messages.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace deltamap;
  try {
    (void)tool::read_bag(fuzz::text_of({data, size}), [](const tool::MessageView& message) {
      try {
        (void)tool::scan_in(message);
      } catch (const std::runtime_error&) {
      }
      try {
        (void)tool::poses_in(message);
      } catch (const std::runtime_error&) {
      }
    });
  } catch (const std::runtime_error&) {
  }
  return 0;
}
