// SPDX-License-Identifier: Apache-2.0
#include "simulation/devices/scan_telegram.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

namespace deltamap::simulation::devices {
namespace {

namespace lms200 = drivers::lms200;
using Kind = lms200::ValueSelection::Kind;
using Words = std::vector<std::uint16_t>;

constexpr std::uint8_t kReflectivity = 100;  // the simulated world has none of its own

/// The mean of the ranges among the sweeps' readings; without one, the last reading.
Beam mean_of(const std::vector<std::vector<Beam>>& sweeps, std::size_t i) {
  double sum_m = 0.0;
  int ranges = 0;
  for (const std::vector<Beam>& sweep : sweeps) {
    if (sweep[i].kind != BeamKind::kRange) continue;
    sum_m += static_cast<double>(sweep[i].range_m);
    ++ranges;
  }
  Beam beam = sweeps.back()[i];
  if (ranges > 0) {
    beam.kind = BeamKind::kRange;
    beam.range_m = static_cast<float>(sum_m / ranges);
  }
  return beam;
}

Words every(const Words& words, std::size_t step) {
  Words some;
  for (std::size_t i = 0; i < words.size(); i += step) some.push_back(words[i]);
  return some;
}

Words within(const Words& words, const lms200::ValueRange& range) {
  const std::size_t end = std::min<std::size_t>(range.to, words.size());
  const std::size_t begin = std::min<std::size_t>(range.from - 1u, end);
  return {words.begin() + static_cast<std::ptrdiff_t>(begin), words.begin() + static_cast<std::ptrdiff_t>(end)};
}

std::vector<std::uint8_t> with_reflectivity(const lms200::ValueSelection& selection, const lms200::RangeCoding& coding,
                                            const lms200::Measurement& head) {
  std::vector<lms200::ReflectingRange> parts;
  for (const lms200::ValueRange& range : selection.ranges) {
    lms200::ReflectingRange part{range, head, {}};
    part.measurement.indices.reset();
    part.measurement.words = within(head.words, range);
    for (const std::uint16_t word : part.measurement.words) {
      part.reflectivity.push_back(lms200::code_name(word, coding) ? 0 : kReflectivity);
    }
    parts.push_back(std::move(part));
  }
  return lms200::encoded_reflecting_ranges(parts);
}

}  // namespace

bool can_be_sent(const lms200::ValueSelection& selection, unsigned values) {
  constexpr unsigned kMostWithReflectivity = 250;  // three bytes each: in one telegram (B1)
  unsigned sum = 0;
  for (const lms200::ValueRange& range : selection.ranges) {
    if (range.to > values) return false;
    sum += range.to - range.from + 1u;
  }
  return selection.kind != Kind::kWithReflectivity || sum <= kMostWithReflectivity;
}

std::vector<std::uint8_t> scan_telegram(const lms200::ValueSelection& selection,
                                        const std::vector<std::vector<Beam>>& sweeps, const lms200::RangeCoding& coding,
                                        lms200::Measurement head) {
  assert(sweeps.size() == selection.mean_of && "as many sweeps as the mean takes");
  for (std::size_t i = 0; i < sweeps.front().size(); ++i) {
    const Beam beam = mean_of(sweeps, i);
    const bool is_zero = beam.kind == BeamKind::kRange && beam.range_m == 0.0F;  // no range: a laser that is broken
    head.words.push_back(is_zero ? std::uint16_t{0} : lms200::encoded_beam(beam, coding, head.metres_per_word()));
  }
  if (head.is_partial && head.partial_number != 0) head.words.pop_back();  // 180 values (B6)
  switch (selection.kind) {
    case Kind::kAll:
    case Kind::kPartial:
      break;
    case Kind::kSmallest:
      head.words = {*std::min_element(head.words.begin(), head.words.end())};  // codes are greater than any range
      break;
    case Kind::kEverySecond:
      head.words = every(head.words, 2);
      break;
    case Kind::kEveryTwentieth:
      head.words = every(head.words, 20);
      break;
    case Kind::kMean:
      return lms200::encoded_selected_values({selection.mean_of, std::nullopt, std::move(head)});
    case Kind::kSubRange:
      head.words = within(head.words, selection.ranges.front());
      return lms200::encoded_selected_values({std::nullopt, selection.ranges.front(), std::move(head)});
    case Kind::kMeanSubRange:
      head.words = within(head.words, selection.ranges.front());
      return lms200::encoded_selected_values({selection.mean_of, selection.ranges.front(), std::move(head)});
    case Kind::kWithReflectivity:
      return with_reflectivity(selection, coding, head);
  }
  return lms200::encoded_measurement(head);
}

}  // namespace deltamap::simulation::devices
