// SPDX-License-Identifier: Apache-2.0
#include "daemon/maps/stored_things.hpp"

#include <string_view>

namespace deltamap::daemon {
namespace {

using mapping::store::StoredRevision;
using mapping::things::ThingEvent;
using mapping::things::Things;

/// By its cause, as the store keeps it.
bool takes_back(const StoredRevision& revision) {
  const std::string_view cause = revision.note.cause;
  return cause.starts_with("withdrawn") || cause.starts_with("undo of ") || cause.starts_with("rolled back to ");
}

}  // namespace

Things things_of(const mapping::store::MapStore& store, const mapping::things::ThingsParams& params,
                 const ThingTold& told, const std::function<void()>& beat, std::uint32_t newest) {
  Things things{params};
  OccupancyGrid map;
  for (const StoredRevision& revision : store.history()) {
    if (beat) beat();
    if (revision.refused) continue;
    if (revision.number > newest) break;
    if (map.box().empty()) {  // the first that the store holds
      map = store.grid(revision.number);
      continue;
    }
    const std::vector<CellChange> changes = store.changes(revision.number);
    map = patched(std::move(map), changes);
    for (const ThingEvent& event : things.take({revision.number, revision.time, map, changes, takes_back(revision)})) {
      if (told) told(event);
    }
  }
  return things;
}

std::vector<ThingEvent> take_result(Things& things, const MapStep::Result& result) {
  if (!result.revision) return {};
  const MapRevision& revision = *result.revision;
  const bool takes_back = result.note.by_operator || !result.note.withdraws.empty();
  return things.take({revision.number, revision.time, *revision.map, revision.changes, takes_back});
}

}  // namespace deltamap::daemon
