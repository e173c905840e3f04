// SPDX-License-Identifier: Apache-2.0
#include "core/files/grid_shades.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/counted.hpp"
#include "core/files/shortest_text.hpp"

namespace deltamap {
namespace {

constexpr Shade kOccupiedShade = 0;  // map_saver's, of 255
constexpr Shade kUnknownShade = 205;
constexpr Shade kFreeShade = 254;
constexpr double kFewPixels = 0.005;  // of all: so many of one shade between are drawn, not the blur of an edge
constexpr double kHardlyAny = 0.001;  // of all: so few unknown cells may be strays
constexpr double kFewBeside = 0.25;   // of a drawn shade: fewer unknown cells do not tell that it is none
constexpr double kWholeEdge = 0.95;   // of the picture's outermost pixels
constexpr double kNearAnEnd = 0.1;    // of the light: a shade so near to black or white is meant for that

/// The shade of 255 that this one is exactly.
std::optional<Shade> of_255(Shade shade, Shade brightest) {
  const std::uint64_t scaled = std::uint64_t{shade} * 255;
  if (scaled % brightest != 0) return std::nullopt;
  return static_cast<Shade>(scaled / brightest);
}

bool is_map_savers(const ShadeCensus& census) {
  for (Shade shade = 0; shade <= census.brightest; ++shade) {
    if (census.pixels[shade] == 0) continue;
    const auto told = of_255(shade, census.brightest);
    if (!told || (*told != kOccupiedShade && *told != kUnknownShade && *told != kFreeShade)) return false;
  }
  return true;
}

double darkness_of(Shade shade, Shade brightest, const GridDescription& keys) {
  const double light = static_cast<double>(shade) / brightest;
  return keys.negate ? light : 1.0 - light;
}

CellState by_thresholds(double darkness, const GridDescription& keys) {
  if (darkness > keys.occupied_threshold) return CellState::kOccupied;
  return darkness < keys.free_threshold ? CellState::kFree : CellState::kUnknown;
}

CellState as_meant(Shade shade_of_255, bool negate) {
  if (shade_of_255 == kUnknownShade) return CellState::kUnknown;
  return (shade_of_255 == kOccupiedShade) != negate ? CellState::kOccupied : CellState::kFree;
}

std::string percent(double share) { return std::to_string(std::llround(100.0 * share)) + " %"; }

std::string word_of(CellState state) {
  return state == CellState::kFree ? "free" : state == CellState::kOccupied ? "occupied" : "unknown";
}

/// Counts of cells, and what is said of them.
class Doubts {
 public:
  Doubts(const ShadeCensus& census, const GridDescription& keys)
      : census_{census}, keys_{keys}, states_{states_of(census, keys)}, is_exact_{is_map_savers(census)} {
    for (std::size_t shade = 0; shade < states_.size(); ++shade) {
      cells_[static_cast<std::size_t>(states_[shade])] += census.pixels[shade];
      all_ += census.pixels[shade];
    }
  }

  [[nodiscard]] std::vector<std::string> told() {
    judge_thresholds();
    is_exact_ ? judge_exact() : judge_between();
    if (!is_exact_ && keys_.lines.free_threshold == 0) add(0, "'free_thresh' is not given: 0.196 is taken");
    if (!is_exact_ && keys_.lines.occupied_threshold == 0) add(0, "'occupied_thresh' is not given: 0.65 is taken");
    judge_negate();
    judge_unknown();
    return std::move(lines_);
  }

 private:
  void add(int line, const std::string& why) {
    lines_.push_back((line > 0 ? "line " + std::to_string(line) + ": " : "") + why);
  }
  [[nodiscard]] std::uint64_t count(CellState state) const { return cells_[static_cast<std::size_t>(state)]; }
  [[nodiscard]] std::string share(std::uint64_t pixels) const {
    return percent(static_cast<double>(pixels) / static_cast<double>(all_));
  }

  void judge_thresholds() {
    is_swapped_ = keys_.occupied_threshold < keys_.free_threshold;
    if (!is_swapped_) return;
    add(keys_.lines.free_threshold, "'occupied_thresh' (" + shortest_text(keys_.occupied_threshold) +
                                        ") lies below 'free_thresh' (" + shortest_text(keys_.free_threshold) +
                                        "): are they swapped?");
  }

  /// Which key a shade owes a state to that the thresholds give it.
  [[nodiscard]] std::string by_key(CellState state) const {
    return state == CellState::kFree ? "'free_thresh' " + shortest_text(keys_.free_threshold)
                                     : "'occupied_thresh' " + shortest_text(keys_.occupied_threshold);
  }
  [[nodiscard]] int line_of(CellState state) const {
    return state == CellState::kFree ? keys_.lines.free_threshold : keys_.lines.occupied_threshold;
  }

  /// The thresholds that a picture of map_saver's shades is not read by.
  void judge_exact() {
    if (is_swapped_ || keys_.negate) return;  // told with these keys
    for (Shade shade = 0; shade <= census_.brightest; ++shade) {
      if (census_.pixels[shade] == 0) continue;
      const CellState otherwise = by_thresholds(darkness_of(shade, census_.brightest, keys_), keys_);
      if (otherwise == states_[shade]) continue;
      const CellState by = otherwise == CellState::kUnknown ? states_[shade] : otherwise;
      add(line_of(by), by_key(by) + " would make shade " + std::to_string(*of_255(shade, census_.brightest)) + " " +
                           word_of(otherwise) + ": it is read as " + word_of(states_[shade]) +
                           ", as map_saver means it (0.65 and 0.196 are its thresholds)");
    }
  }

  /// The most frequent shade between black and white that counts as free or occupied, where it is drawn.
  void judge_between() {
    Shade most = 0;
    std::uint64_t pixels = 0;
    for (Shade shade = 1; shade < census_.brightest; ++shade) {
      const double light = static_cast<double>(shade) / census_.brightest;
      if (light < kNearAnEnd || light > 1.0 - kNearAnEnd || states_[shade] == CellState::kUnknown) continue;
      if (is_drawn(shade) && census_.pixels[shade] > pixels) {
        most = shade;
        pixels = census_.pixels[shade];
      }
      if (of_255(shade, census_.brightest) == kUnknownShade && is_drawn(shade)) return tell_unknown_shade(shade);
    }
    if (most == 0 || static_cast<double>(count(CellState::kUnknown)) >= kFewBeside * static_cast<double>(pixels))
      return;
    between_ = "shade " + std::to_string(most) + " of " + std::to_string(census_.brightest) + " (" +
               share(census_.pixels[most]) + " of the cells) counts as " + word_of(states_[most]) + " by " +
               by_key(states_[most]);
    between_line_ = line_of(states_[most]);
  }
  /// Scattered cells of another shade do not make a map whose unknown is known.
  void judge_unknown() {
    const auto unknown = count(CellState::kUnknown);
    const double share = static_cast<double>(unknown) / static_cast<double>(all_);
    const bool is_hardly_any = share < kHardlyAny;
    const std::string few =
        unknown == 0 ? "nothing is unknown" : "hardly anything is unknown (" + counted(unknown, "cell") + ")";
    if (is_hardly_any) {
      add(0, few + ": " + between_ + (between_.empty() ? "" : "; ") +
                 "what no robot has seen is not told from floor and walls");
    } else if (!between_.empty()) {
      add(between_line_,
          between_ + ", and only " + counted(unknown, "cell is", "cells are") + " unknown: is it right?");
    } else if (share > kFewPixels && edge_share(CellState::kFree) >= kWholeEdge) {
      add(0, percent(edge_share(CellState::kFree)) +
                 " of the picture's edge is free: is what lies outside drawn white? What no robot has seen is unknown "
                 "(205)");
    }
  }
  [[nodiscard]] double edge_share(CellState state) const {
    std::uint64_t all = 0;
    std::uint64_t in_state = 0;
    for (std::size_t shade = 0; shade < states_.size(); ++shade) {
      all += census_.edge[shade];
      in_state += states_[shade] == state ? census_.edge[shade] : 0;
    }
    return static_cast<double>(in_state) / static_cast<double>(all);
  }
  [[nodiscard]] bool is_drawn(Shade shade) const {
    return static_cast<double>(census_.pixels[shade]) >= kFewPixels * static_cast<double>(all_);
  }
  void tell_unknown_shade(Shade shade) {
    const bool is_free = states_[shade] == CellState::kFree;
    add(line_of(states_[shade]), "shade 205, map_saver's unknown, counts as " + word_of(states_[shade]) + " (" +
                                     share(census_.pixels[shade]) + " of the cells) by " + by_key(states_[shade]) +
                                     (is_free && !keys_.negate ? "; 0.196 is meant" : ""));
  }

  void judge_negate() {
    const auto free = count(CellState::kFree);
    const auto occupied = count(CellState::kOccupied);
    if (occupied > free) {
      add(keys_.lines.negate, "more is occupied (" + std::to_string(occupied) + " cells) than free (" +
                                  std::to_string(free) + "): is 'negate' (" + (keys_.negate ? "1" : "0") + ") right?");
    } else if (is_exact_ && keys_.negate) {
      add(keys_.lines.negate, "'negate' is 1, and the picture has map_saver's own shades, which need 0: is it right?");
    }
  }

  const ShadeCensus& census_;
  const GridDescription& keys_;
  std::vector<CellState> states_;
  bool is_exact_;
  bool is_swapped_ = false;
  std::array<std::uint64_t, 3> cells_{};
  std::uint64_t all_ = 0;
  std::string between_;  // what a shade between black and white counts as, in place of unknown
  int between_line_ = 0;
  std::vector<std::string> lines_;
};

}  // namespace

ShadeCensus census_of(PictureReader& picture) {
  const std::vector<std::uint64_t> none(std::size_t{picture.brightest()} + 2);
  ShadeCensus census{picture.brightest(), none, none};
  std::vector<Shade> row(static_cast<std::size_t>(picture.width()));
  for (int i = 0; i < picture.height(); ++i) {
    picture.read_row(row);
    for (auto first = row.begin(); first != row.end();) {  // by runs: most of a map is of one shade
      const auto last = std::find_if(first, row.end(), [&](Shade shade) { return shade != *first; });
      census.pixels[*first] += static_cast<std::uint64_t>(last - first);
      first = last;
    }
    const bool is_outermost = i == 0 || i + 1 == picture.height();
    for (std::size_t at = 0; at < row.size(); at += is_outermost ? 1 : std::max<std::size_t>(1, row.size() - 1))
      ++census.edge[row[at]];
  }
  return census;
}

std::vector<CellState> states_of(const ShadeCensus& census, const GridDescription& keys) {
  const bool is_exact = is_map_savers(census);
  std::vector<CellState> states(census.pixels.size(), CellState::kUnknown);
  for (Shade shade = 0; shade <= census.brightest; ++shade) {
    const auto told = is_exact && census.pixels[shade] > 0 ? of_255(shade, census.brightest) : std::nullopt;
    states[shade] =
        told ? as_meant(*told, keys.negate) : by_thresholds(darkness_of(shade, census.brightest, keys), keys);
  }
  return states;
}

std::vector<std::string> doubts_of(const ShadeCensus& census, const GridDescription& keys) {
  return Doubts{census, keys}.told();
}

}  // namespace deltamap
