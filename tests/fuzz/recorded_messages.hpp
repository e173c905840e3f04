// SPDX-License-Identifier: Apache-2.0
// The messages of another program's recording, taken for what their types say and for what they do not.
#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>

#include "tests/fuzz/input.hpp"
#include "tool/import/message_file.hpp"
#include "tool/import/ros_messages.hpp"

namespace deltamap::fuzz {

/// `read`: read_bag or read_mcap. Errors that they tell are no finding.
template <typename Read>
void try_recording(const Read& read, const std::uint8_t* data, std::size_t size) {
  const auto tried = [](const auto& call) {
    try {
      (void)call();
    } catch (const std::runtime_error&) {
    }
  };
  tried([&] {
    return read(text_of({data, size}), [&](const tool::MessageView& message) {
      tried([&] { return tool::scan_in(message); });
      tried([&] { return tool::poses_in(message); });
    });
  });
}

}  // namespace deltamap::fuzz
