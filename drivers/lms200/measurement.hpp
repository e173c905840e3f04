// SPDX-License-Identifier: Apache-2.0
// The B0h telegram with its measured words, and the way from it to a core Scan: ranges and kinds by the measuring mode,
// bearings by the variant, and each beam's own time from the turning mirror (protocols.md B4, B6, B7).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/messages.hpp"
#include "drivers/lms200/configuration.hpp"
#include "drivers/lms200/telegram.hpp"
#include "drivers/lms200/variant.hpp"

namespace deltamap::drivers::lms200 {

/// A B0h telegram as sent.
struct Measurement {
  struct Indices {
    std::uint8_t scan = 0;      ///< counts mirror turns modulo 256
    std::uint8_t telegram = 0;  ///< counts telegrams modulo 256
    friend bool operator==(const Indices&, const Indices&) = default;
  };

  std::vector<std::uint16_t> words;  ///< counter-clockwise from the right, raw
  std::uint8_t unit_code = 0;        ///< 0 cm, 1 mm, 2 is 10 cm
  bool is_partial = false;           ///< one raster of an interlaced scan
  std::uint8_t partial_number = 0;   ///< 0 to 3: the raster begins at 0.25 degrees times this
  std::optional<Indices> indices;    ///< where the configuration sends them
  std::uint8_t status = kNormalStatus;

  friend bool operator==(const Measurement&, const Measurement&) = default;

  [[nodiscard]] double metres_per_word() const;
};

/// nullopt for other telegrams, a word count that does not fit the length, or a unit code that nobody knows.
[[nodiscard]] std::optional<Measurement> decoded_measurement(const Telegram& telegram);
/// The whole telegram.
[[nodiscard]] std::vector<std::uint8_t> encoded_measurement(const Measurement& measurement);

/// The data of such a telegram alone, which others have after fields of their own (value_selection.hpp).
[[nodiscard]] std::optional<Measurement> measurement_from(std::span<const std::uint8_t> data, std::uint8_t status);
[[nodiscard]] std::vector<std::uint8_t> measurement_data(const Measurement& measurement);
/// How many words its head announces; 0 where there is none.
[[nodiscard]] std::size_t words_announced(std::span<const std::uint8_t> data);

/// What a measurement does not say about itself.
struct ScanFormat {
  std::uint8_t measuring_mode = 0;  ///< byte 5 of the configuration: the mask follows from it, not from the units (B4)
  double max_range_m = 0.0;         ///< longer ranges become kBeyondMaximum; 0: as far as the mode goes
  Pose2 robot_from_laser{};         ///< the mount
  bool is_upside_down = false;      ///< mounted so: its values come from left to right
  std::optional<ScanVariant> variant{};  ///< as the laser has told it; nothing, or one of other values: by their number
};

/// The scan without its number. nullopt for a mode without ranges and a count of values that belongs to no variant.
/// Scan::time is first_byte less the scan's duration: the device sends when the scan is complete (B7).
[[nodiscard]] std::optional<Scan> scan_from(const Measurement& measurement, const ScanFormat& format,
                                            Timestamp first_byte, Timestamp received);

/// Range and kind of one word; the beam's time is left to the caller.
[[nodiscard]] Beam decoded_beam(std::uint16_t word, const RangeCoding& coding, double metres_per_word,
                                double max_range_m);
/// What a word says that is no range: "not valid", "overflow", ... (B4); nullopt for ranges.
[[nodiscard]] std::optional<std::string> code_name(std::uint16_t word, const RangeCoding& coding);
/// The word that makes scan_from answer this beam: for simulator and import. Ranges are rounded to the unit; 0 and
/// ranges that reach into the codes become "beyond maximum".
[[nodiscard]] std::uint16_t encoded_beam(const Beam& beam, const RangeCoding& coding, double metres_per_word);

/// Seconds from a scan's begin to one of its beams (B7): the mirror turns once for each raster of one degree.
[[nodiscard]] double beam_offset_s(const ScanVariant& variant, unsigned beam);

}  // namespace deltamap::drivers::lms200
