// SPDX-License-Identifier: Apache-2.0
#include "drivers/lms200/value_selection.hpp"

#include <algorithm>
#include <array>
#include <cassert>

#include "drivers/byte_fields.hpp"
#include "drivers/lms200/command.hpp"

namespace deltamap::drivers::lms200 {
namespace {

using Kind = ValueSelection::Kind;

constexpr std::size_t kMostRanges = 5;
constexpr unsigned kFewestScans = 2;
constexpr unsigned kMostScans = 250;

/// How a kind is asked for: a command with perhaps a first data byte, then the number of scans, then ranges.
struct Form {
  Kind kind;
  std::uint8_t command;
  std::optional<std::uint8_t> first;
};

constexpr auto kForms = std::to_array<Form>({
    {Kind::kAll, command::kSetMode, mode::kStreamAll},
    {Kind::kMean, command::kSetMode, mode::kStreamMean},
    {Kind::kSubRange, command::kSetMode, mode::kStreamSubRange},
    {Kind::kMeanSubRange, command::kSetMode, mode::kStreamMeanSubRange},
    {Kind::kPartial, command::kSetMode, mode::kStreamPartial},
    {Kind::kWithReflectivity, command::kSetMode, mode::kStreamReflectivity},
    {Kind::kAll, command::kRequestScan, 0x01},
    {Kind::kSmallest, command::kRequestScan, 0x02},
    {Kind::kEverySecond, command::kRequestScan, 0x06},
    {Kind::kEveryTwentieth, command::kRequestScan, 0x07},
    {Kind::kPartial, command::kRequestScan, 0x08},
    {Kind::kMean, command::kRequestMean, std::nullopt},
    {Kind::kSubRange, command::kRequestSubRange, std::nullopt},
    {Kind::kMeanSubRange, command::kRequestMeanSubRange, std::nullopt},
});

bool has_mean(Kind kind) { return kind == Kind::kMean || kind == Kind::kMeanSubRange; }
bool has_one_range(Kind kind) { return kind == Kind::kSubRange || kind == Kind::kMeanSubRange; }

ValueRange range_from(FieldReader& fields) {
  ValueRange range;
  range.from = fields.u16();
  range.to = fields.u16();
  return range;
}

bool is_in_order(const ValueRange& range) { return range.from >= 1 && range.from <= range.to; }

}  // namespace

std::optional<ValueSelection> requested_selection(const Telegram& request) {
  if (request.kind != Telegram::Kind::kTelegram) return std::nullopt;
  const auto* form = std::find_if(kForms.begin(), kForms.end(), [&](const Form& f) {
    return f.command == request.command && (!f.first || (!request.data.empty() && request.data[0] == *f.first));
  });
  if (form == kForms.end()) return std::nullopt;
  FieldReader fields{request.data};
  if (form->first) (void)fields.u8();
  ValueSelection selection{form->kind, 1, {}};
  if (has_mean(form->kind)) selection.mean_of = fields.u8();
  std::size_t ranges = has_one_range(form->kind) ? 1 : 0;
  if (form->kind == Kind::kWithReflectivity) {
    ranges = fields.u16();
    if (ranges == 0 || ranges > kMostRanges) return std::nullopt;
  }
  for (std::size_t i = 0; i < ranges; ++i) selection.ranges.push_back(range_from(fields));
  const bool can_be_meant =
      !has_mean(form->kind) || (selection.mean_of >= kFewestScans && selection.mean_of <= kMostScans);
  const bool is_good = fields.is_good() && fields.left() == 0 && can_be_meant &&
                       std::all_of(selection.ranges.begin(), selection.ranges.end(), is_in_order);
  return is_good ? std::optional{selection} : std::nullopt;
}

std::vector<std::uint8_t> selection_request(const ValueSelection& selection, bool as_stream) {
  const auto fits = [&](bool streams) {
    return std::find_if(kForms.begin(), kForms.end(), [&](const Form& f) {
      return f.kind == selection.kind && (f.command == command::kSetMode) == streams;
    });
  };
  const auto* form = fits(as_stream);
  if (form == kForms.end()) form = fits(!as_stream);
  FieldWriter data;
  if (form->first) data.u8(*form->first);
  if (has_mean(selection.kind)) data.u8(selection.mean_of);
  if (selection.kind == Kind::kWithReflectivity) data.u16(static_cast<unsigned>(selection.ranges.size()));
  for (const ValueRange& range : selection.ranges) data.u16(range.from).u16(range.to);
  return encoded_request(form->command, data.written());
}

std::vector<std::uint8_t> encoded_selected_values(const SelectedValues& values) {
  assert((values.mean_of || values.range) && "a plain scan is B0h");
  FieldWriter data;
  if (values.mean_of) data.u8(*values.mean_of);
  if (values.range) data.u16(values.range->from).u16(values.range->to);
  data.bytes(measurement_data(values.measurement));
  const std::uint8_t response = !values.range     ? response::kMeanScan
                                : !values.mean_of ? response::kSubRange
                                                  : response::kMeanSubRange;
  return encoded_reply(response, data.written(), values.measurement.status);
}

std::optional<SelectedValues> decoded_selected_values(const Telegram& telegram) {
  const bool is_mean = telegram.command == response::kMeanScan;
  const bool is_range = telegram.command == response::kSubRange;
  const bool is_both = telegram.command == response::kMeanSubRange;
  if (telegram.kind != Telegram::Kind::kTelegram || !(is_mean || is_range || is_both)) return std::nullopt;
  FieldReader fields{telegram.data};
  SelectedValues values;
  if (is_mean || is_both) values.mean_of = fields.u8();
  if (is_range || is_both) values.range = range_from(fields);
  const auto rest = std::span{telegram.data}.last(fields.left());
  auto measurement = fields.is_good() ? measurement_from(rest, telegram.status) : std::nullopt;
  if (!measurement) return std::nullopt;
  values.measurement = std::move(*measurement);
  return values;
}

std::vector<std::uint8_t> encoded_reflecting_ranges(const std::vector<ReflectingRange>& ranges) {
  assert(!ranges.empty() && ranges.size() <= kMostRanges && "one to five ranges");
  FieldWriter data;
  data.u16(static_cast<unsigned>(ranges.size()));
  for (const ReflectingRange& part : ranges) {
    assert(part.reflectivity.size() == part.measurement.words.size() && "one for each word");
    data.u16(part.range.from).u16(part.range.to).bytes(measurement_data(part.measurement)).bytes(part.reflectivity);
  }
  return encoded_reply(response::kReflectivity, data.written(), ranges.front().measurement.status);
}

std::optional<std::vector<ReflectingRange>> decoded_reflecting_ranges(const Telegram& telegram) {
  if (telegram.kind != Telegram::Kind::kTelegram || telegram.command != response::kReflectivity) return std::nullopt;
  FieldReader fields{telegram.data};
  const std::size_t count = fields.u16();
  if (count == 0 || count > kMostRanges) return std::nullopt;
  std::vector<ReflectingRange> ranges(count);
  for (ReflectingRange& part : ranges) {
    part.range = range_from(fields);
    const auto rest = std::span{telegram.data}.last(fields.left());
    const std::size_t words = words_announced(rest);
    const std::size_t size = 2 + 2 * words;
    if (!fields.is_good() || fields.left() < size + words) return std::nullopt;
    auto measurement = measurement_from(rest.first(size), telegram.status);
    if (!measurement) return std::nullopt;
    part.measurement = std::move(*measurement);
    for (std::size_t i = 0; i < size; ++i) (void)fields.u8();
    part.reflectivity.resize(words);
    for (std::uint8_t& value : part.reflectivity) value = fields.u8();
  }
  return fields.left() == 0 ? std::optional{ranges} : std::nullopt;
}

std::vector<std::uint8_t> counters_reply(const OperatingCounters& counters) {
  constexpr unsigned kHoursPerCount = 2;
  return encoded_reply(response::kCounters,
                       FieldWriter{}.u16(counters.hours / kHoursPerCount).u16(counters.switch_ons).written());
}

std::optional<OperatingCounters> decoded_counters(const Telegram& telegram) {
  constexpr std::uint32_t kHoursPerCount = 2;
  if (telegram.kind != Telegram::Kind::kTelegram || telegram.command != response::kCounters) return std::nullopt;
  FieldReader fields{telegram.data};
  OperatingCounters counters;
  counters.hours = kHoursPerCount * fields.u16();
  counters.switch_ons = fields.u16();
  return fields.is_good() && fields.left() == 0 ? std::optional{counters} : std::nullopt;
}

}  // namespace deltamap::drivers::lms200
