// SPDX-License-Identifier: Apache-2.0
#include "daemon/maps/kept_bays.hpp"

#include <array>
#include <exception>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/files/text_of_file.hpp"
#include "daemon/settings/fingerprint.hpp"

namespace deltamap::daemon {
namespace {

using mapping::bays::Bay;
using mapping::bays::BayState;
using mapping::bays::BayStatus;
using KeptBaysJson = nlohmann::ordered_json;

constexpr std::array kStates{BayState::kUnknown, BayState::kEmpty, BayState::kPartly, BayState::kFull};

/// Throws KeptBaysJson::exception.
std::pair<Bay, BayStatus> bay_in(const KeptBaysJson& json) {
  std::pair<Bay, BayStatus> kept;
  auto& [bay, status] = kept;
  bay.id = json.at("bay").get<std::string>();
  for (const KeptBaysJson& corner : json.at("polygon_m"))
    bay.polygon.emplace_back(corner.at(0).get<double>(), corner.at(1).get<double>());
  const auto state = json.at("state").get<std::string>();
  for (const BayState one : kStates) {
    if (name_of(one) == state) status.state = one;
  }
  status.share = json.at("share").get<double>();
  status.confidence = json.at("confidence").get<double>();
  status.seen = timestamp_from_ns(json.at("seen_ns").get<std::int64_t>());
  status.since = timestamp_from_ns(json.at("since_ns").get<std::int64_t>());
  return kept;
}

bool is_same_place(const Bay& one, const Bay& other) { return one.id == other.id && one.polygon == other.polygon; }

}  // namespace

std::string kept_text(const BayList& list, std::uint64_t first_map) {
  KeptBaysJson json{{"map", hex_of(first_map)}, {"bays", KeptBaysJson::array()}};
  for (std::size_t i = 0; i < list.bays.size(); ++i) {
    const BayStatus& status = list.statuses[i];
    if (status.state == BayState::kUnknown || !status.seen || !status.since) continue;
    KeptBaysJson bay{{"bay", list.bays[i].id}, {"polygon_m", KeptBaysJson::array()}};
    for (const Point2& corner : list.bays[i].polygon) bay["polygon_m"].push_back({corner.x(), corner.y()});
    bay["state"] = name_of(status.state);
    bay["share"] = status.share;
    bay["confidence"] = status.confidence;
    bay["seen_ns"] = unix_ns(*status.seen);
    bay["since_ns"] = unix_ns(*status.since);
    json["bays"].push_back(std::move(bay));
  }
  return json.dump(-1, ' ', false, KeptBaysJson::error_handler_t::replace) + "\n";
}

BayList bays_of_kept_text(std::string_view text, std::uint64_t first_map, Timestamp now) {
  try {
    const auto json = KeptBaysJson::parse(text);
    if (json.at("map") != hex_of(first_map)) return {};
    BayList list;
    for (const KeptBaysJson& one : json.at("bays")) {
      auto [bay, status] = bay_in(one);
      if (status.state == BayState::kUnknown || *status.seen > now) continue;
      list.bays.push_back(std::move(bay));
      list.statuses.push_back(status);
    }
    return list;
  } catch (const KeptBaysJson::exception&) {
    return {};
  }
}

std::shared_ptr<const BayList> RememberedBays::beside(const BayList& known) {
  auto list = std::make_shared<BayList>(known);
  list->is_remembered.assign(list->bays.size(), false);
  for (std::size_t i = 0; i < list->bays.size() && !list_.bays.empty(); ++i) {
    for (std::size_t kept = 0; kept < list_.bays.size(); ++kept) {
      if (!is_same_place(list_.bays[kept], list->bays[i])) continue;
      const bool was_known = known.statuses[i].since.has_value();
      if (was_known) {
        list_.statuses[kept] = {};
      } else if (list_.statuses[kept].state != BayState::kUnknown) {
        list->statuses[i] = list_.statuses[kept];
        list->is_remembered[i] = true;
      }
    }
  }
  return list;
}

RememberedBays remembered_bays(const std::filesystem::path& file, std::uint64_t first_map, Timestamp now) {
  if (file.empty()) return {};
  try {
    return RememberedBays{bays_of_kept_text(text_of_file(file), first_map, now)};
  } catch (const std::exception&) {
    return {};  // none is there
  }
}

}  // namespace deltamap::daemon
