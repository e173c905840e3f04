// SPDX-License-Identifier: Apache-2.0
// Which of its measured values a laser is asked for, once (30h, 36h, 37h, 3Fh) or as a stream (20h), and the telegrams
// that carry them where they are not the plain scan of measurement.hpp: B5h to B7h, BFh, F5h (protocols.md B3, B6).
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "drivers/lms200/measurement.hpp"
#include "drivers/lms200/telegram.hpp"

namespace deltamap::drivers::lms200 {

/// Values counted from 1, both ends included.
struct ValueRange {
  std::uint16_t from = 1;
  std::uint16_t to = 1;
  friend bool operator==(const ValueRange&, const ValueRange&) = default;
};

struct ValueSelection {
  enum class Kind {
    kAll,
    kSmallest,         ///< one value: the smallest distance
    kEverySecond,      ///< the first, the third, ...
    kEveryTwentieth,   ///< the first, the 21st, ...
    kPartial,          ///< one raster of an interlaced scan
    kMean,             ///< over some scans
    kSubRange,         ///< one range
    kMeanSubRange,     ///< one range, over some scans
    kWithReflectivity  ///< one to five ranges of partial scans
  };
  Kind kind = Kind::kAll;
  std::uint8_t mean_of = 1;        ///< scans
  std::vector<ValueRange> ranges;  ///< none: all values
  friend bool operator==(const ValueSelection&, const ValueSelection&) = default;

  [[nodiscard]] bool is_partial() const { return kind == Kind::kPartial || kind == Kind::kWithReflectivity; }
};

/// What a request asks for; nullopt for other requests, and where its data are not as B3 says.
[[nodiscard]] std::optional<ValueSelection> requested_selection(const Telegram& request);
/// As a stream (20h), or once; the host's telegram. Every kind can be asked for in one of the two ways at least: those
/// that 20h does not know are asked for once whatever is said.
[[nodiscard]] std::vector<std::uint8_t> selection_request(const ValueSelection& selection, bool as_stream);

/// B6h, B7h and BFh: a measurement of part of the values or of means.
struct SelectedValues {
  std::optional<std::uint8_t> mean_of;
  std::optional<ValueRange> range;
  Measurement measurement;
  friend bool operator==(const SelectedValues&, const SelectedValues&) = default;
};
/// One of the two must be there: the response follows from which.
[[nodiscard]] std::vector<std::uint8_t> encoded_selected_values(const SelectedValues& values);
[[nodiscard]] std::optional<SelectedValues> decoded_selected_values(const Telegram& telegram);

/// A range of F5h: as many reflectivities as words.
struct ReflectingRange {
  ValueRange range;
  Measurement measurement;  ///< without indices
  std::vector<std::uint8_t> reflectivity;
  friend bool operator==(const ReflectingRange&, const ReflectingRange&) = default;
};
[[nodiscard]] std::vector<std::uint8_t> encoded_reflecting_ranges(const std::vector<ReflectingRange>& ranges);
[[nodiscard]] std::optional<std::vector<ReflectingRange>> decoded_reflecting_ranges(const Telegram& telegram);

/// B5h.
struct OperatingCounters {
  std::uint32_t hours = 0;  ///< of operation; even: told in units of two
  std::uint16_t switch_ons = 0;
  friend bool operator==(const OperatingCounters&, const OperatingCounters&) = default;
};
[[nodiscard]] std::vector<std::uint8_t> counters_reply(const OperatingCounters& counters);
[[nodiscard]] std::optional<OperatingCounters> decoded_counters(const Telegram& telegram);

}  // namespace deltamap::drivers::lms200
