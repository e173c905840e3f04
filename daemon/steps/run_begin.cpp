// SPDX-License-Identifier: Apache-2.0
#include "daemon/steps/run_begin.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <span>

#include "daemon/records/journal.hpp"
#include "daemon/settings/fingerprint.hpp"
#include "mapping/store/map_codec.hpp"

namespace deltamap::daemon {
namespace {

using Json = nlohmann::ordered_json;
using Bytes = std::vector<std::uint8_t>;

constexpr std::string_view kHead = "began from";
constexpr std::string_view kSettingHead = "setting ";
constexpr std::size_t kTileBytes = localization::belief::StabilityRecord::kBytesATile;

std::string_view as_text(std::span<const std::uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::span<const std::uint8_t> as_bytes(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

/// Run-length coding of tiles, most of which are equal: length (1 to 255), tile.
Bytes packed_tiles(const Bytes& tiles) {
  Bytes packed;
  for (std::size_t at = 0; at + kTileBytes <= tiles.size();) {
    const auto tile = std::span(tiles).subspan(at, kTileBytes);
    std::size_t run = 1;
    while (run < 255 && at + (run + 1) * kTileBytes <= tiles.size() &&
           std::equal(tile.begin(), tile.end(), tiles.begin() + static_cast<std::ptrdiff_t>(at + run * kTileBytes))) {
      ++run;
    }
    packed.push_back(static_cast<std::uint8_t>(run));
    packed.insert(packed.end(), tile.begin(), tile.end());
    at += run * kTileBytes;
  }
  return packed;
}

Bytes unpacked_tiles(std::string_view packed) {
  Bytes tiles;
  for (; packed.size() > kTileBytes; packed.remove_prefix(1 + kTileBytes)) {
    for (unsigned run = static_cast<unsigned char>(packed[0]); run > 0; --run) {
      for (const char byte : packed.substr(1, kTileBytes)) tiles.push_back(static_cast<std::uint8_t>(byte));
    }
  }
  return tiles;
}

Json as_json(const GridGeometry& geometry) {
  return {{"width", geometry.width},
          {"height", geometry.height},
          {"resolution_m", geometry.resolution_m},
          {"origin_m", {geometry.origin.x(), geometry.origin.y()}}};
}

GridGeometry geometry_in(const Json& json) {
  return {json.at("width").get<int>(), json.at("height").get<int>(), json.at("resolution_m").get<double>(),
          Point2{json.at("origin_m").at(0).get<double>(), json.at("origin_m").at(1).get<double>()}};
}

/// How far off the pose of a scan may be where the next one comes: a part of a run begins a moment after the scan.
PoseDeviation deviation_soon_after(const LocalizationRow& row) {
  constexpr double kMomentS = 0.2;
  const PoseDeviation own = pose_deviation(row.covariance);
  return {std::hypot(own.position_m, kMomentS * row.speed_m_per_s, 0.05),
          std::hypot(own.heading_rad, kMomentS * row.turn_rate_rad_per_s, 0.02)};
}

/// What is known of the robot: its pose, and what was learned of wheels and mount. False where that is malformed.
bool read_robot(const Json& head, StartMap& start) {
  if (const auto pose = head.find("pose"); pose != head.end()) {
    start.remembered = Pose2{pose->at(0).get<double>(), pose->at(1).get<double>(), pose->at(2).get<double>()};
  }
  if (const auto believed = head.find("believed"); believed != head.end()) {
    start.believed = PoseDeviation{believed->at(0).get<double>(), believed->at(1).get<double>()};
  }
  const auto calibration = head.find("calibration");
  if (calibration == head.end()) return true;
  start.calibration = localization::motion::calibration_of(calibration->get<std::vector<double>>());
  return start.calibration.has_value();
}

/// Decodes what begin_notes() writes. Throws Json::exception for a malformed head; nullopt for malformed bytes.
std::optional<RunBegin> begin_in(const Json& head, std::string_view bytes) {
  RunBegin begin;
  begin.first_map = head.at("first_map").get<std::uint64_t>();
  begin.memory = head.at("memory").get<std::uint64_t>();
  begin.start.revision = head.at("revision").get<std::uint32_t>();
  if (!read_robot(head, begin.start)) return std::nullopt;
  const auto map_size = head.at("map_bytes").get<std::size_t>();
  if (map_size > bytes.size()) return std::nullopt;
  if (const auto map = head.find("map"); map != head.end()) {
    auto grid = mapping::store::decoded_grid(as_bytes(bytes.substr(0, map_size)), geometry_in(*map));
    if (!grid) return std::nullopt;
    begin.start.map = std::make_shared<const OccupancyGrid>(std::move(*grid));
  }
  bytes.remove_prefix(map_size);
  if (const auto provisional = head.find("provisional"); provisional != head.end()) {
    if (!begin.start.map) return std::nullopt;
    for (const Json& revision : *provisional) {
      const auto size = revision.at(1).get<std::size_t>();
      if (size > bytes.size()) return std::nullopt;
      auto changes = mapping::store::decoded_changes(as_bytes(bytes.substr(0, size)), begin.start.map->geometry());
      if (!changes) return std::nullopt;
      begin.start.provisional.push_back({revision.at(0).get<std::uint32_t>(), *std::move(changes)});
      bytes.remove_prefix(size);
    }
  }
  if (const auto stability = head.find("stability"); stability != head.end()) {
    begin.start.stability = {geometry_in(*stability), stability->at("cells_a_tile").get<int>(), unpacked_tiles(bytes)};
  }
  return begin;
}

std::optional<RunBegin> begin_of(const std::string& content) {
  const auto end = content.find('\n');
  if (end == std::string::npos) return std::nullopt;
  try {
    return begin_in(Json::parse(content.begin(), content.begin() + static_cast<std::ptrdiff_t>(end)),
                    std::string_view(content).substr(end + 1));
  } catch (const Json::exception&) {
    return std::nullopt;
  }
}

}  // namespace

std::vector<std::string> begin_notes(const RunBegin& begin) {
  const StartMap& start = begin.start;
  if (start.revision == 0 && !start.remembered && !start.stability && !start.calibration) return {};
  Json head{{"first_map", begin.first_map}, {"memory", begin.memory}, {"revision", start.revision}};
  Bytes bytes;
  if (start.revision > 0) {
    head["map"] = as_json(start.map->geometry());
    bytes = mapping::store::encoded_grid(*start.map);
  }
  head["map_bytes"] = bytes.size();
  for (const ProvisionalRevision& revision : start.provisional) {
    const Bytes changes = mapping::store::encoded_changes(revision.changes, start.map->geometry());
    head["provisional"].push_back({revision.number, changes.size()});
    bytes.insert(bytes.end(), changes.begin(), changes.end());
  }
  if (start.calibration) head["calibration"] = localization::motion::numbers_of(*start.calibration);
  if (start.remembered) head["pose"] = {start.remembered->x, start.remembered->y, start.remembered->theta};
  if (start.believed) head["believed"] = {start.believed->position_m, start.believed->heading_rad};
  if (start.stability) {
    head["stability"] = as_json(start.stability->geometry);
    head["stability"]["cells_a_tile"] = start.stability->cells_a_tile;
    const Bytes tiles = packed_tiles(start.stability->bytes);
    bytes.insert(bytes.end(), tiles.begin(), tiles.end());
  }
  return notes_in_parts(kHead, head.dump().append("\n").append(as_text(bytes)));
}

std::vector<std::string> first_notes(const Settings& settings, std::uint64_t map, const RunBegin& begin) {
  std::vector<std::string> notes{note_of(RunIdentity{settings_fingerprint(settings), map, begin.memory})};
  for (std::string& note : begin_notes(begin)) notes.push_back(std::move(note));
  for (const auto& [key, value] : changed_settings(settings)) {
    // A reader takes a note apart at line ends.
    if (value.find('\n') == std::string::npos) notes.push_back(std::string(kSettingHead) + key + ": " + value);
  }
  return notes;
}

Settings settings_of_a_part(Settings settings) {
  settings.initial_pose.reset();
  return settings;
}

Checkpoint checkpoint_of(const LocalizationStep& step, std::uint64_t first_map,
                         std::shared_ptr<const OccupancyGrid> map) {
  return {.row = step.row(),
          .pose = kept_pose_of(step.row(), first_map, step.calibration()),
          .map = std::move(map),
          .stability = step.stability()};
}

std::vector<std::string> part_notes(const Settings& settings, const Checkpoint& from) {
  const LocalizationRow& row = from.row;
  RunBegin begin{.first_map = from.pose.first_map, .memory = fingerprint_of(json_text(from.pose)), .start = {}};
  begin.start = {.map = from.map, .revision = from.pose.revision};
  begin.start.calibration = from.pose.calibration;
  begin.start.stability = from.stability;
  if (from.pose.is_sure) {
    begin.start.remembered = from.pose.map_from_robot;
    begin.start.believed = deviation_soon_after(row);
  }
  return first_notes(settings_of_a_part(settings), grid_hash(*from.map), begin);
}

std::optional<std::pair<std::string, std::string>> setting_of_note(std::string_view note) {
  if (!note.starts_with(kSettingHead)) return std::nullopt;
  note.remove_prefix(kSettingHead.size());
  const std::size_t colon = note.find(": ");
  if (colon == std::string_view::npos) return std::nullopt;
  return std::pair{std::string(note.substr(0, colon)), std::string(note.substr(colon + 2))};
}

BeginReader::BeginReader() : parts_{kHead} {}

void BeginReader::read(std::string_view note) {
  if (!parts_.read(note)) return;
  begin_.reset();
  if (const auto& content = parts_.content()) begin_ = begin_of(*content);
}

}  // namespace deltamap::daemon
