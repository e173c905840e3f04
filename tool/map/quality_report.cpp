// SPDX-License-Identifier: Apache-2.0
#include "tool/map/quality_report.hpp"

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "core/counted.hpp"
#include "daemon/maps/png_bytes.hpp"
#include "tool/picture/scene.hpp"

namespace deltamap::tool {
namespace {

using surveying::quality::Flaw;
using surveying::quality::FoundFlaw;
using surveying::quality::kFlaws;
using surveying::quality::MapQuality;
using Json = nlohmann::ordered_json;

constexpr std::size_t kMostTold = 20;  // places of one flaw

/// As it stands in JSON.
const char* name_of(Flaw flaw) {
  switch (flaw) {
    case Flaw::kDoubledWalls:
      return "doubled_walls";
    case Flaw::kWallsSeenThrough:
      return "walls_seen_through";
    case Flaw::kOpenLoops:
      return "open_loops";
    case Flaw::kTornWay:
      return "torn_way";
    case Flaw::kWrongScale:
      return "wrong_scale";
    case Flaw::kLooseWay:
      return "loose_way";
    case Flaw::kWallsDrivenThrough:
      return "walls_driven_through";
    case Flaw::kUnfitScans:
      return "unfit_scans";
  }
  return "";
}

template <typename... Values>
std::string text(const char* format, Values... values) {
  char line[240];
  (void)std::snprintf(line, sizeof line, format, values...);
  return line;
}

std::string where(const FoundFlaw& flaw) {
  std::string line;
  constexpr std::size_t kInLine = 3;
  for (std::size_t i = 0; i < std::min(kInLine, flaw.places.size()); ++i) {
    line += text("%s%.1f,%.1f", i == 0 ? " at " : " ", flaw.places[i].x(), flaw.places[i].y());
  }
  if (flaw.places.size() > kInLine) line += text(" and %zu more", flaw.places.size() - kInLine);
  return line;
}

std::string what(Flaw flaw, const MapQuality& quality) {
  const FoundFlaw& found = quality.of(flaw);
  switch (flaw) {
    case Flaw::kDoubledWalls:
      return text("walls stand twice, %.1f m apart", found.size_m);
    case Flaw::kWallsSeenThrough:
      return text("walls stand where another pass saw %.1f m farther", found.size_m);
    case Flaw::kOpenLoops:
      return text("passes of one place disagree by %.1f m, a loop is open", found.size_m);
    case Flaw::kTornWay:
      return text("scans that follow each other disagree by %.1f m", found.size_m);
    case Flaw::kWrongScale:
      return text("the way is drawn %.1f %% too %s", 100.0 * std::abs(quality.scale.error),
                  quality.scale.error > 0.0 ? "long" : "short");
    case Flaw::kLooseWay:
      return text("%.0f m of way hang on the wheels alone", found.size_m);
    case Flaw::kWallsDrivenThrough:
      return "the robot drove through walls";
    case Flaw::kUnfitScans:
      return std::to_string(quality.fit.unfit) + " of " + counted(quality.fit.scans, "scan") +
             (quality.fit.unfit == 1 ? " does not fit the map" : " do not fit the map");
  }
  return "";
}

Json places_as_json(const std::vector<Point2>& places) {
  Json json = Json::array();
  for (std::size_t i = 0; i < std::min(kMostTold, places.size()); ++i) {
    const auto rounded = [](double metres) { return std::round(metres * 100.0) / 100.0; };
    json.push_back({rounded(places[i].x()), rounded(places[i].y())});
  }
  return json;
}

}  // namespace

std::vector<std::string> quality_lines(const MapQuality& quality) {
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < kFlaws; ++i) {
    const auto flaw = static_cast<Flaw>(i);
    if (quality.of(flaw).is_beyond_limit) lines.push_back("false: " + what(flaw, quality) + where(quality.of(flaw)));
  }
  if (lines.empty()) {
    lines.push_back(
        text("no contradiction beyond limits: %zu of %zu pairs of passes disagree, scale off by %.1f %%, "
             "%.0f %% of the ends explained",
             quality.disagreeing, quality.pairs, 100.0 * quality.scale.error, 100.0 * quality.fit.explained_share));
  }
  return lines;
}

std::string quality_as_json(const MapQuality& quality) {
  Json flaws = Json::object();
  for (std::size_t i = 0; i < kFlaws; ++i) {
    const FoundFlaw& found = quality.flaws[i];
    flaws[name_of(static_cast<Flaw>(i))] = {{"beyond_limit", found.is_beyond_limit},
                                            {"size_m", found.size_m},
                                            {"places", found.places.size()},
                                            {"at", places_as_json(found.places)}};
  }
  return Json{{"false", quality.is_false()},
              {"scans", quality.scans},
              {"passes", quality.passes},
              {"pairs_compared", quality.pairs},
              {"pairs_disagreeing", quality.disagreeing},
              {"passes_out_of_place", quality.out_of_place},
              {"scale_error", quality.scale.error},
              {"loose_way_m", quality.loose_m},
              {"scans_unfit", quality.fit.unfit},
              {"ends_explained", quality.fit.explained_share},
              {"flaws", flaws}}
      .dump();
}

void draw_quality(const OccupancyGrid& map, const MapQuality& quality, const std::string& png) {
  picture::Scene scene{.map = map};
  for (const FoundFlaw& flaw : quality.flaws) {
    scene.doubted.insert(scene.doubted.end(), flaw.places.begin(), flaw.places.end());
  }
  picture::Raster raster;
  try {
    raster = drawn(scene);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(png + ": cannot be drawn: " + error.what());
  }
  daemon::write_bytes(daemon::png_of(raster.width, raster.height, raster.rgb), png);
}

}  // namespace deltamap::tool
