// SPDX-License-Identifier: Apache-2.0
#include "daemon/stages/map_stage.hpp"

#include <chrono>
#include <cstdio>
#include <string>
#include <utility>

#include "core/counted.hpp"
#include "daemon/outputs/bay_note.hpp"
#include "daemon/outputs/thing_note.hpp"
#include "daemon/settings/memory_places.hpp"
#include "drivers/port/port_clock.hpp"

namespace deltamap::daemon {
namespace {

using drivers::port::port_clock_now;

constexpr std::chrono::seconds kRetryPeriod{1};  // between looks at outputs that could not be written

/// "revision 9 takes revision 7 back: 41 cells, 3 have changed since and stay"
std::string words_of(const MapOrder& order, const MapRevision& made, const mapping::store::MapStore::Undoing& wanted) {
  if (order.kind == MapOrder::Kind::kUndoThing) {
    return "revision " + std::to_string(made.number) + " takes thing " + std::to_string(order.thing) +
           " back from the next scan on: " + counted(made.changes.size(), "cell");
  }
  const std::string number = std::to_string(order.revision);
  const std::string first = std::to_string(order.revision - wanted.held_before);
  const std::string all = wanted.held_before > 0 ? "revisions " + first + " to " + number : "revision " + number;
  std::string text = "revision " + std::to_string(made.number) + " ";
  text += order.kind == MapOrder::Kind::kUndo ? "takes " + all + " back" : "is " + all + " again";
  text += " from the next scan on: " + counted(made.changes.size(), "cell");
  return wanted.kept == 0
             ? text
             : text + ", " + counted(wanted.kept, "has changed since and stays", "have changed since and stay");
}

/// " added=12 freed=3 forgotten=0"
std::string cells_in(const ChangeNote& note) {
  return " added=" + std::to_string(note.added) + " freed=" + std::to_string(note.freed) +
         " forgotten=" + std::to_string(note.forgotten);
}

/// " scans=120 acceptance=0.973"
std::string evidence_of(const ChangeNote& note) {
  char acceptance[16];
  (void)std::snprintf(acceptance, sizeof acceptance, "%.3f", note.acceptance);
  return " scans=" + std::to_string(note.scans) + " acceptance=" + acceptance;
}

StoreToKeep with_retention(StoreToKeep store, const mapping::store::Retention& retention) {
  store.retention = retention;
  return store;
}

}  // namespace

MapStage::MapStage(const Settings& settings, const StartMap& start, std::uint64_t first_map,
                   const std::optional<std::filesystem::path>& out, StoreToKeep store, Wiring wiring)
    : wiring_{std::move(wiring)},
      step_{settings, start},
      things_{{.store = store.store ? &*store.store : nullptr,
               .out = out,
               .kept = memory_places(settings.map.store).things,
               .params = settings.mapping.things},
              wiring_.telemetry.outputs,
              wiring_.warn,
              port_clock_now()},
      bays_{{.out = out,
             .kept = settings.bays.file.empty() ? "" : memory_places(settings.map.store).bays,
             .seen = settings.bays.file.empty() ? "" : memory_places(settings.map.store).bays_seen,
             .first_map = first_map},
            wiring_.telemetry.outputs,
            wiring_.warn,
            port_clock_now()},
      outputs_{{.out = out,
                .store_file = settings.map.store,
                .newest_file = settings.map.newest,
                .store = with_retention(std::move(store), settings.map.retention),
                .start = {.map = start.map, .revision = start.revision},
                .method = step_.method()},
               wiring_.telemetry.outputs,
               wiring_.warn,
               port_clock_now()} {
  wiring_.things.set(things_.list());
}

void MapStage::run(const std::deque<MapWork>& rest) {
  while (!wiring_.work.is_drained()) {
    pulse_.beat();
    if (const auto work = wiring_.work.receive_within(kRetryPeriod)) take(*work);
    outputs_.retry(port_clock_now());
    things_.retry(port_clock_now());
    bays_.retry(port_clock_now());
    bays_.keep(*wiring_.bays.newest(), port_clock_now());
  }
  for (const MapWork& work : rest) take(work);
  outputs_.close(port_clock_now());
  things_.close(port_clock_now());
  bays_.close(*wiring_.bays.newest(), port_clock_now());
}

void MapStage::take(const MapWork& work) {
  if (const auto* request = std::get_if<MapRequest>(&work)) {
    if (const auto result = step_.take(*request)) return tell_and_hand_on(*result);
    outputs_.settle(port_clock_now());
  } else if (const auto* event = std::get_if<mapping::bays::BayEvent>(&work)) {
    tell_bay(*event);
  } else if (const auto* site = std::get_if<SharedSite>(&work)) {
    step_.set_zones((*site)->zones);
  } else if (const auto* look = std::get_if<ThingLook>(&work)) {
    tell_things(things_.look(**look, port_clock_now()));
  } else {
    obey(std::get<MapOrder>(work));
  }
}

void MapStage::tell_and_hand_on(const MapStep::Result& result) {
  if (!result.revision) {
    wiring_.telemetry.refused.add(1);
    if (mapping::scan_set::leaves_map_stale(result.refusal)) wiring_.telemetry.stale_refusals.add(1);
    wiring_.log("map unchanged: phase=" + std::to_string(result.note.phase) + evidence_of(result.note) +
                " verdict=refused reason=" + result.note.reason);
    return hand_on(result);
  }
  if (!result.note.withdraws.empty()) {
    wiring_.log("pose proved wrong: withdrawn=" + counted(result.note.withdraws.size(), "revision"));
  }
  wiring_.log("map changed: revision=" + std::to_string(result.revision->number) +
              " phase=" + std::to_string(result.note.phase) + cells_in(result.note) + evidence_of(result.note) +
              " verdict=" + (result.note.withdraws.empty() ? "accepted" : "withdrawn"));
  hand_on(result);
}

void MapStage::obey(const MapOrder& order) {
  const GridGeometry& geometry = step_.map()->geometry();
  mapping::store::MapStore::Undoing wanted;
  try {
    wanted = cells_of(order);
  } catch (const std::exception& error) {
    return wiring_.answer({order.ticket, false, std::string("not done: ") + error.what()});
  }
  const SetCells set{order, geometry.width, geometry.height, std::move(wanted.changes)};
  const MapStep::Result result = step_.obey(set);
  if (!result.revision) return wiring_.answer({order.ticket, false, "not done: " + result.note.reason});
  note(set);
  wiring_.log("map changed: revision=" + std::to_string(result.revision->number) + cells_in(result.note) +
              " reason=" + result.note.reason);
  hand_on(result);
  const std::string behind = outputs_.why_behind();
  wiring_.answer({order.ticket, true,
                  words_of(order, *result.revision, wanted) +
                      (behind.empty() ? std::string{} : "; not in the store yet: " + behind)});
}

mapping::store::MapStore::Undoing MapStage::cells_of(const MapOrder& order) const {
  if (order.kind != MapOrder::Kind::kUndoThing) return outputs_.cells_of(order, *step_.map());
  return {.changes = things_.undoing(order.thing, *step_.map())};
}

void MapStage::note(const SetCells& set) {
  for (std::string& part : notes_of(set)) (void)wiring_.recorder.try_send(std::move(part));
}

void MapStage::hand_on(const MapStep::Result& result) {
  changes_.add(result.note);
  // First whoever serves maps, then the localizer: no pose names a revision that a planner cannot ask for.
  wiring_.show(result.revision ? &*result.revision : nullptr, result.note);
  if (result.revision) {
    wiring_.telemetry.newest_revision.set(result.revision->number);
    MapRevision published = *result.revision;
    (void)wiring_.revisions.try_send(std::move(published));
  }
  outputs_.save(result, port_clock_now());
  tell_things(things_.take(result, port_clock_now()));
}

void MapStage::tell_things(const std::vector<mapping::things::ThingEvent>& events) {
  for (const auto& event : events) {
    wiring_.tell_thing(json_line(event));
    if (event.is_new) wiring_.log("thing " + std::to_string(event.thing.id) + ": " + words_of(event.thing));
  }
  if (!events.empty()) wiring_.things.set(things_.list());
}

void MapStage::tell_bay(const mapping::bays::BayEvent& event) {
  wiring_.log(words_of(event));
  const auto things = wiring_.things.newest();
  bays_.take(event, things->things, port_clock_now());
  wiring_.tell_bay(json_line(event, things->things));
}

}  // namespace deltamap::daemon
