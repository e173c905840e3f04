// SPDX-License-Identifier: Apache-2.0
#include "daemon/outputs/change_note.hpp"

#include <nlohmann/json.hpp>

namespace deltamap::daemon {
namespace {

using Json = nlohmann::ordered_json;

Json as_json(const ChangeNote& change) {
  Json json;
  json["time"] = unix_seconds(change.time);
  json["phase"] = change.phase;
  json["scans"] = change.scans;
  json["accepted"] = change.revision.has_value();
  json["revision"] = change.revision ? Json(*change.revision) : Json(nullptr);
  json["added"] = change.added;
  json["freed"] = change.freed;
  json["forgotten"] = change.forgotten;
  json["box_m"] = {change.box_low.x(), change.box_low.y(), change.box_high.x(), change.box_high.y()};
  json["acceptance"] = change.acceptance;
  json["reason"] = change.reason;
  if (change.by_operator) json["operator"] = true;
  if (!change.withdraws.empty()) json["withdraws"] = change.withdraws;
  return json;
}

}  // namespace

std::string json_line(const ChangeNote& change) { return as_json(change).dump() + "\n"; }

void ChangeTally::add(const ChangeNote& change) {
  if (!change.revision) {
    ++refused_;
    ++refusals_[change.reason];
    return;
  }
  ++accepted_;
  if (!change.withdraws.empty()) ++withdrawals_;
  revisions_.push_back({*change.revision, change.time, change.phase, change.added, change.freed, change.forgotten});
  if (revisions_.size() > kKept) revisions_.pop_front();
}

}  // namespace deltamap::daemon
