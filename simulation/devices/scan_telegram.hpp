// SPDX-License-Identifier: Apache-2.0
// The telegram that a laser makes of its sweeps where a host has asked for some of the values, or for their means
// (protocols.md B3, B6).
#pragma once

#include <cstdint>
#include <vector>

#include "core/messages.hpp"
#include "drivers/lms200/configuration.hpp"
#include "drivers/lms200/measurement.hpp"
#include "drivers/lms200/value_selection.hpp"

namespace deltamap::simulation::devices {

/// Whether a laser with so many values can send it in one telegram.
[[nodiscard]] bool can_be_sent(const drivers::lms200::ValueSelection& selection, unsigned values);

/// `sweeps`: as many as the selection takes means of, all of one length. `head`: unit, status, indices and the raster
/// of a partial scan; its words are filled in.
[[nodiscard]] std::vector<std::uint8_t> scan_telegram(const drivers::lms200::ValueSelection& selection,
                                                      const std::vector<std::vector<Beam>>& sweeps,
                                                      const drivers::lms200::RangeCoding& coding,
                                                      drivers::lms200::Measurement head);

}  // namespace deltamap::simulation::devices
