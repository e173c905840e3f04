// SPDX-License-Identifier: Apache-2.0
#include "daemon/records/map_order.hpp"

#include <array>
#include <nlohmann/json.hpp>
#include <span>
#include <utility>

#include "mapping/store/map_codec.hpp"

namespace deltamap::daemon {
namespace {

using Json = nlohmann::ordered_json;
using Kind = MapOrder::Kind;

constexpr std::string_view kHead = "map order";
constexpr int kLongestSide = 32767;  // of a map, cells

/// A lattice of this size for the codec of changes, which needs indices alone: no resolution, no origin.
GridGeometry lattice_of(int width, int height) { return {width, height, 1.0, {0.0, 0.0}}; }

/// Decodes what notes_of() writes. Throws Json::exception for a malformed head; null for malformed bytes.
std::shared_ptr<const SetCells> set_cells_in(const Json& head, std::string_view bytes) {
  SetCells set;
  const auto& order = head.at("order");
  set.order.kind = order == "undo" ? Kind::kUndo : order == "undo thing" ? Kind::kUndoThing : Kind::kRollBack;
  set.order.thing = head.value("thing", 0U);
  set.order.revision = head.at("revision").get<std::uint32_t>();
  set.order.scan = head.at("scan").get<std::uint32_t>();
  set.order.scan_time = timestamp_from_ns(head.at("time_ns").get<std::int64_t>());
  set.width = head.at("width").get<int>();
  set.height = head.at("height").get<int>();
  if (set.width <= 0 || set.height <= 0 || set.width > kLongestSide || set.height > kLongestSide) return nullptr;
  auto changes = mapping::store::decoded_changes(
      std::span(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()), lattice_of(set.width, set.height));
  if (!changes) return nullptr;
  set.changes = *std::move(changes);
  return std::make_shared<const SetCells>(std::move(set));
}

}  // namespace

std::string reason_of(const MapOrder& order) {
  if (order.kind == Kind::kUndoThing) return "undo of thing " + std::to_string(order.thing) + " by an operator";
  return (order.kind == Kind::kUndo ? "undo of " : "rolled back to ") + std::to_string(order.revision) +
         " by an operator";
}

std::vector<std::string> notes_of(const SetCells& set) {
  constexpr std::array<const char*, 3> kNames{"undo", "rollback", "undo thing"};
  Json head{{"order", kNames[static_cast<std::size_t>(set.order.kind)]},
            {"revision", set.order.revision},
            {"scan", set.order.scan},
            {"time_ns", unix_ns(set.order.scan_time)},
            {"width", set.width},
            {"height", set.height}};
  if (set.order.kind == Kind::kUndoThing) head["thing"] = set.order.thing;
  const auto bytes = mapping::store::encoded_changes(set.changes, lattice_of(set.width, set.height));
  std::string content = head.dump() + "\n";
  content.append(bytes.begin(), bytes.end());
  return notes_in_parts(kHead, content);
}

SetCellsReader::SetCellsReader() : parts_{kHead} {}

std::shared_ptr<const SetCells> SetCellsReader::read(std::string_view note) {
  if (!parts_.read(note)) return nullptr;
  const std::optional<std::string> content = parts_.content();
  if (!content) return nullptr;
  parts_ = PartsReader{kHead};
  const auto end = content->find('\n');
  if (end == std::string::npos) return nullptr;
  try {
    return set_cells_in(Json::parse(content->begin(), content->begin() + static_cast<std::ptrdiff_t>(end)),
                        std::string_view(*content).substr(end + 1));
  } catch (const Json::exception&) {
    return nullptr;
  }
}

}  // namespace deltamap::daemon
