// SPDX-License-Identifier: Apache-2.0
// Is a map false? Scans that drew it agree with it whatever it is worth, so the witnesses are passes of different
// times: they are held against each other at the poses that the map gives them. Beyond the limits below the map is
// false.
//
// A map that is bent where nobody comes again cannot be told from a true one.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "surveying/quality/map_fit.hpp"
#include "surveying/quality/map_scale.hpp"

namespace deltamap::surveying::quality {

// Each limit lies between what good maps show (recorded logs, simulated buildings with people in them) and what maps
// that were bent on purpose show; docs/operating/first-map.md has both.
/// Of the pairs of passes: furniture, doors and glass make at most 2.8 % of them disagree.
inline constexpr double kMostDisagreeing = 0.04;
/// Of a pass's pairs: where three in five disagree it is drawn at a wrong place. Good maps: half, and that pass is off.
inline constexpr double kMostOfPass = 0.6;
/// Error of the way between passes: 10 cm in 10 m, a cell or two. Good maps: 0.2 %.
inline constexpr double kMostScaleError = 0.01;
/// Way of all pieces but the longest: on more than this a robot's wheels turn the map by degrees.
inline constexpr double kMostLooseM = 5.0;
/// Places: two doors that were shut behind the robot.
inline constexpr std::size_t kMostDrivenThrough = 2;
/// Of the scans. Good maps: 0.5 %.
inline constexpr double kMostUnfit = 0.02;

enum class Flaw : std::uint8_t {
  kDoubledWalls,        ///< passes of different times draw them decimetres apart
  kWallsSeenThrough,    ///< beams of another time went far through them
  kOpenLoops,           ///< places that were visited twice, whose passes disagree
  kTornWay,             ///< passes that follow each other disagree
  kWrongScale,          ///< the way between scans is longer or shorter than they say
  kLooseWay,            ///< nothing but the wheels holds it to the rest
  kWallsDrivenThrough,  ///< the robot's own way leads through them
  kUnfitScans           ///< the finished map explains less than half of their ends
};
inline constexpr std::size_t kFlaws = 8;

struct FoundFlaw {
  bool is_beyond_limit = false;
  std::vector<Point2> places{};  ///< map frame, the worst first
  double size_m = 0.0;           ///< at the worst: how far apart, how deep behind, how long
};

struct MapQuality {
  std::size_t scans = 0;
  std::size_t passes = 0;
  std::size_t pairs = 0;         ///< of passes that see so much in common that they can agree or disagree
  std::size_t disagreeing = 0;   ///< of them
  std::size_t out_of_place = 0;  ///< passes most of whose pairs disagree
  MapScale scale{};
  double loose_m = 0.0;
  MapFit fit{};
  std::array<FoundFlaw, kFlaws> flaws{};

  [[nodiscard]] const FoundFlaw& of(Flaw flaw) const { return flaws[static_cast<std::size_t>(flaw)]; }
  [[nodiscard]] bool is_false() const;
};

/// `scans` in order of time, drive by drive, all that were taken or a part of them.
[[nodiscard]] MapQuality map_quality(const OccupancyGrid& map, std::span<const PlacedScan> scans);

}  // namespace deltamap::surveying::quality
