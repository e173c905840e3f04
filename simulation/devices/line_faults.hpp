// SPDX-License-Identifier: Apache-2.0
// What goes wrong on the line between a device and its host, on order. Everything at its default: nothing.
#pragma once

#include <optional>

namespace deltamap::simulation::devices {

struct LineFaults {
  bool is_cut = false;        ///< carries nothing in either direction
  bool is_mute = false;       ///< the host hears nothing, the device does
  bool is_deaf = false;       ///< the device hears nothing, the host does
  bool is_unplugged = false;  ///< the host's adapter is out: its port hangs up, and there is none to open

  std::optional<unsigned> baud{};  ///< at which the device speaks and hears, whatever was agreed

  // Damage to what the device sends, by share of its frames, [0, 1].
  double noisy_share = 0.0;      ///< random bytes come before the frame
  double flipped_share = 0.0;    ///< one bit of the frame is another
  double truncated_share = 0.0;  ///< the frame's end is lost
  double pause_s = 0.0;          ///< somewhere inside each frame, >= 0

  friend bool operator==(const LineFaults&, const LineFaults&) = default;
};

}  // namespace deltamap::simulation::devices
