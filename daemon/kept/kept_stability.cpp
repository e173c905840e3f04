// SPDX-License-Identifier: Apache-2.0
#include "daemon/kept/kept_stability.hpp"

#include <nlohmann/json.hpp>

#include "daemon/kept/kept_text.hpp"
#include "daemon/settings/fingerprint.hpp"
#include "localization/belief/stability.hpp"

namespace deltamap::daemon {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uintmax_t kLargestStabilityFile = 256u << 20u;

std::string_view as_text(const std::vector<std::uint8_t>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// The head as file_text() writes it; throws Json::exception where it is anything else.
KeptStability head_in(const Json& json) {
  KeptStability kept;
  kept.first_map = json.at("map").get<std::uint64_t>();
  kept.revision = json.at("revision").get<std::uint32_t>();
  auto& geometry = kept.record.geometry;
  geometry.width = json.at("width").get<int>();
  geometry.height = json.at("height").get<int>();
  geometry.resolution_m = json.at("resolution_m").get<double>();
  geometry.origin = {json.at("origin_x_m").get<double>(), json.at("origin_y_m").get<double>()};
  kept.record.cells_a_tile = json.at("cells_a_tile").get<int>();
  return kept;
}

/// The record in a file of file_text(); nullopt where the file is cut, damaged or foreign.
std::optional<KeptStability> kept_in(const std::string& text) {
  const auto end = text.find('\n');
  if (end == std::string::npos) return std::nullopt;
  try {
    const Json json = Json::parse(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(end));
    KeptStability kept = head_in(json);
    kept.record.bytes.assign(text.begin() + static_cast<std::ptrdiff_t>(end) + 1, text.end());
    if (json.at("checksum").get<std::uint64_t>() != fingerprint_of(as_text(kept.record.bytes))) return std::nullopt;
    return kept;
  } catch (const Json::exception&) {
    return std::nullopt;
  }
}

}  // namespace

std::string file_text(const KeptStability& kept) {
  const GridGeometry& geometry = kept.record.geometry;
  const std::string_view bytes = as_text(kept.record.bytes);
  Json json;
  json["map"] = kept.first_map;
  json["revision"] = kept.revision;
  json["width"] = geometry.width;
  json["height"] = geometry.height;
  json["resolution_m"] = geometry.resolution_m;
  json["origin_x_m"] = geometry.origin.x();
  json["origin_y_m"] = geometry.origin.y();
  json["cells_a_tile"] = kept.record.cells_a_tile;
  json["checksum"] = fingerprint_of(bytes);
  return json.dump().append("\n").append(bytes);
}

KeptStabilityAnswer read_kept_stability(const std::filesystem::path& file, std::uint64_t first_map) {
  KeptStabilityAnswer answer;
  std::error_code error;
  if (!std::filesystem::exists(std::filesystem::status(file, error))) return answer;
  const std::string text = kept_text(file, kLargestStabilityFile);
  answer.kept = kept_in(text);
  if (!answer.kept) {
    answer.why_not = file.string() + ": holds nothing about stability, or is damaged";
  } else if (answer.kept->first_map != first_map) {
    answer = {std::nullopt, file.string() + ": what has proven stable belongs to another map", 0};
  } else {
    answer.fingerprint = fingerprint_of(text);
  }
  return answer;
}

localization::belief::StabilityRecord without(const localization::belief::StabilityRecord& record,
                                              std::span<const CellChange> changes) {
  localization::belief::Stability stability{record.geometry};
  if (!stability.restore(record)) return record;  // a record of other tiles: the localizer will refuse it too
  stability.forget(changes);
  return stability.record();
}

}  // namespace deltamap::daemon
