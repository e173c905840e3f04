// SPDX-License-Identifier: Apache-2.0
#include "drivers/lms200/measurement.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "drivers/byte_fields.hpp"
#include "drivers/lms200/command.hpp"

namespace deltamap::drivers::lms200 {
namespace {

// Fields of the count word (protocols.md B6).
constexpr unsigned kCountMask = 0x03FF;
constexpr unsigned kPartialNumberShift = 11;
constexpr unsigned kPartialFlag = 0x2000;
constexpr unsigned kUnitShift = 14;
constexpr unsigned kUnknownUnit = 3;

// Codes that stand in place of a range, counted from "beyond maximum" (x..F7).
constexpr unsigned kChannelErrorAfterMaximum = 0x3;
constexpr unsigned kSignalTooWeakAfterMaximum = 0x4;
constexpr unsigned kOverflowAfterMaximum = 0x6;
constexpr unsigned kDazzledAfterMaximum = 0x7;
constexpr unsigned kNotValidAfterMaximum = 0x8;

constexpr double kDegreesPerTurn = 360.0;
constexpr unsigned kPartialValues = 181;  // in a partial scan of raster 0; of the other rasters one less (B6)

/// Where the beams of a scan point and when.
struct Fan {
  double first_angle_deg = 0.0;
  double step_deg = 1.0;
  unsigned rasters = 1;

  [[nodiscard]] double angle_deg(unsigned beam) const { return first_angle_deg + beam * step_deg; }
  [[nodiscard]] double offset_s(unsigned beam) const {
    return (beam % rasters + angle_deg(beam) / kDegreesPerTurn) * kMirrorTurnS;
  }
};

Fan fan_of(const ScanVariant& variant) {
  return {variant.first_angle_deg(), variant.resolution_centideg * 0.01, variant.turns()};
}

std::optional<Fan> fan_of(const Measurement& measurement, const std::optional<ScanVariant>& told) {
  const auto values = static_cast<unsigned>(measurement.words.size());
  if (measurement.is_partial) {
    const unsigned expected = measurement.partial_number == 0 ? kPartialValues : kPartialValues - 1;
    if (values != expected) return std::nullopt;
    return Fan{0.25 * measurement.partial_number, 1.0, 1};
  }
  const bool is_as_told = told && told->values() == values && is_possible(*told);
  const std::optional<ScanVariant> variant = is_as_told ? told : variant_with_values(values);
  return variant ? std::optional{fan_of(*variant)} : std::nullopt;
}

BeamKind kind_of_code(unsigned value, const RangeCoding& coding) {
  const unsigned code = value - coding.beyond_maximum;
  switch (code) {
    case 0:
      return BeamKind::kBeyondMaximum;
    case kDazzledAfterMaximum:
      return BeamKind::kDazzled;
    case kNotValidAfterMaximum:
      return BeamKind::kNotValid;
    default:
      return BeamKind::kOther;
  }
}

}  // namespace

double Measurement::metres_per_word() const {
  constexpr double kMetres[] = {0.01, 0.001, 0.1};
  assert(unit_code < std::size(kMetres) && "a decoded measurement has a unit");
  return kMetres[unit_code];
}

std::size_t words_announced(std::span<const std::uint8_t> data) { return FieldReader{data}.u16() & kCountMask; }

std::optional<Measurement> measurement_from(std::span<const std::uint8_t> data, std::uint8_t status) {
  FieldReader fields{data};
  const unsigned head = fields.u16();
  const std::size_t count = head & kCountMask;
  Measurement measurement;
  measurement.unit_code = static_cast<std::uint8_t>(head >> kUnitShift);
  measurement.is_partial = (head & kPartialFlag) != 0;
  measurement.partial_number = static_cast<std::uint8_t>(head >> kPartialNumberShift & 3u);
  measurement.status = status;
  const bool has_indices = fields.left() == 2 * count + 2;
  const bool fits = fields.is_good() && (fields.left() == 2 * count || has_indices);
  if (!fits || measurement.unit_code == kUnknownUnit) return std::nullopt;
  measurement.words.resize(count);
  for (std::uint16_t& word : measurement.words) word = fields.u16();
  if (has_indices) {
    const std::uint8_t scan = fields.u8();
    measurement.indices = Measurement::Indices{scan, fields.u8()};
  }
  return measurement;
}

std::vector<std::uint8_t> measurement_data(const Measurement& measurement) {
  const auto count = static_cast<unsigned>(measurement.words.size());
  assert(count <= kCountMask && measurement.partial_number < 4 && "the count word has 10 and 2 bits for them");
  FieldWriter data;
  data.u16(count | static_cast<unsigned>(measurement.partial_number) << kPartialNumberShift |
           (measurement.is_partial ? kPartialFlag : 0u) | static_cast<unsigned>(measurement.unit_code) << kUnitShift);
  for (const std::uint16_t word : measurement.words) data.u16(word);
  if (measurement.indices) data.u8(measurement.indices->scan).u8(measurement.indices->telegram);
  return data.written();
}

std::optional<Measurement> decoded_measurement(const Telegram& telegram) {
  if (telegram.kind != Telegram::Kind::kTelegram || telegram.command != response::kScan) return std::nullopt;
  return measurement_from(telegram.data, telegram.status);
}

std::vector<std::uint8_t> encoded_measurement(const Measurement& measurement) {
  return encoded_reply(response::kScan, measurement_data(measurement), measurement.status);
}

std::optional<Scan> scan_from(const Measurement& measurement, const ScanFormat& format, Timestamp first_byte,
                              Timestamp received) {
  const std::optional<RangeCoding> coding = range_coding(format.measuring_mode);
  const std::optional<Fan> fan = fan_of(measurement, format.variant);
  if (!coding || !fan) return std::nullopt;
  const double metres_per_word = measurement.metres_per_word();
  const double mode_max_m = coding->beyond_maximum * metres_per_word;

  Scan scan;
  scan.time = first_byte - duration_from_seconds(fan->rasters * kMirrorTurnS);
  scan.received = received;
  constexpr double kAheadDeg = 90.0;  // angle 90 of the scanner points along the laser frame's x axis
  scan.first_bearing_rad = radians(fan->first_angle_deg - kAheadDeg);
  scan.bearing_step_rad = radians(fan->step_deg);
  scan.max_range_m = format.max_range_m > 0.0 ? std::min(format.max_range_m, mode_max_m) : mode_max_m;
  scan.robot_from_laser = format.robot_from_laser;
  scan.severity = measurement.status & kSeverityBits;
  scan.implausible = (measurement.status & kImplausibleBit) != 0;
  scan.beams.reserve(measurement.words.size());
  for (unsigned i = 0; i < measurement.words.size(); ++i) {
    Beam beam = decoded_beam(measurement.words[i], *coding, metres_per_word, scan.max_range_m);
    beam.offset_s = static_cast<float>(fan->offset_s(i));
    scan.beams.push_back(beam);
  }
  if (format.is_upside_down && !scan.beams.empty()) {
    std::reverse(scan.beams.begin(), scan.beams.end());
    scan.first_bearing_rad = -radians(fan->angle_deg(static_cast<unsigned>(scan.beams.size()) - 1) - kAheadDeg);
  }
  return scan;
}

Beam decoded_beam(std::uint16_t word, const RangeCoding& coding, double metres_per_word, double max_range_m) {
  const unsigned value = word & coding.range_mask;
  if (value >= coding.beyond_maximum) return {.kind = kind_of_code(value, coding)};
  if (value == 0) return {.kind = BeamKind::kNotValid};
  const double range_m = value * metres_per_word;
  constexpr double kRounding = 0.5;  // of a word: a range exactly at the maximum is one
  if (range_m > max_range_m + kRounding * metres_per_word) return {.kind = BeamKind::kBeyondMaximum};
  return {.range_m = static_cast<float>(range_m), .kind = BeamKind::kRange};
}

std::optional<std::string> code_name(std::uint16_t word, const RangeCoding& coding) {
  const unsigned value = word & coding.range_mask;
  if (value < coding.beyond_maximum) return std::nullopt;
  switch (value - coding.beyond_maximum) {
    case 0:
      return "beyond maximum";
    case kChannelErrorAfterMaximum:
      return "channel 1 error";
    case kSignalTooWeakAfterMaximum:
      return "signal too weak";
    case kOverflowAfterMaximum:
      return "overflow";
    case kDazzledAfterMaximum:
      return "dazzled";
    case kNotValidAfterMaximum:
      return "not valid";
    default:
      return "code " + std::to_string(value);
  }
}

std::uint16_t encoded_beam(const Beam& beam, const RangeCoding& coding, double metres_per_word) {
  const auto code = [&](unsigned after_maximum) {
    return static_cast<std::uint16_t>(coding.beyond_maximum + after_maximum);
  };
  switch (beam.kind) {
    case BeamKind::kBeyondMaximum:
      return code(0);
    case BeamKind::kDazzled:
      return code(kDazzledAfterMaximum);
    case BeamKind::kNotValid:
      return code(kNotValidAfterMaximum);
    case BeamKind::kOther:
      return code(kSignalTooWeakAfterMaximum);
    case BeamKind::kRange:
      break;
  }
  const double value = std::round(static_cast<double>(beam.range_m) / metres_per_word);
  if (!(value >= 1.0 && value < coding.beyond_maximum)) return code(0);
  return static_cast<std::uint16_t>(value);
}

double beam_offset_s(const ScanVariant& variant, unsigned beam) { return fan_of(variant).offset_s(beam); }

}  // namespace deltamap::drivers::lms200
