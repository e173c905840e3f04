// SPDX-License-Identifier: Apache-2.0
#include "daemon/maps/things_keeper.hpp"

#include <algorithm>
#include <stdexcept>

#include "daemon/maps/stored_things.hpp"
#include "daemon/outputs/thing_note.hpp"

namespace deltamap::daemon {

using mapping::things::Thing;
using mapping::things::ThingEvent;

ThingsKeeper::ThingsKeeper(const Options& options, OutputBoard& board, const RetryingOutput::Warn& warn, Timestamp now)
    : things_{options.params} {
  if (options.out) {
    const auto file = *options.out / "things.jsonl";
    out_.emplace(file, RetryingOutput{"things", file, board, warn});
    out_->flush(now);
  }
  if (!options.kept.empty()) {
    kept_.emplace(options.kept, RetryingOutput{"kept things", options.kept, board, warn});
    kept_->flush(now);
  }
  if (options.store == nullptr) return;
  try {
    things_ = things_of(*options.store, options.params, [&](const ThingEvent& event) {
      if (kept_) kept_->write(json_line(event), now);
    });
  } catch (const std::exception& error) {
    warn(std::string("things count from here, those before cannot be read: ") + error.what());
  }
  if (kept_) kept_->flush(now);
}

std::vector<ThingEvent> ThingsKeeper::take(const MapStep::Result& result, Timestamp now) {
  std::vector<ThingEvent> events = take_result(things_, result);
  write(events, now);
  return events;
}

std::vector<ThingEvent> ThingsKeeper::look(const TrackedScan& tracked, Timestamp now) {
  std::vector<ThingEvent> events = things_.look(tracked);
  write(events, now);
  return events;
}

void ThingsKeeper::write(const std::vector<ThingEvent>& events, Timestamp now) {
  for (const ThingEvent& event : events) {
    if (out_) out_->write(json_line(event), now);
    if (kept_) kept_->write(json_line(event), now);
  }
  if (!events.empty()) retry(now);
}

std::shared_ptr<const ThingList> ThingsKeeper::list() const {
  return std::make_shared<const ThingList>(ThingList{things_.all(), things_.corrections(), things_.forgotten()});
}

std::vector<CellChange> ThingsKeeper::undoing(std::uint32_t thing, const OccupancyGrid& map) const {
  const std::vector<Thing> all = things_.all();
  const auto found = std::find_if(all.begin(), all.end(), [&](const Thing& one) { return one.id == thing; });
  const std::string name = "thing " + std::to_string(thing);
  if (found == all.end()) throw std::runtime_error("there is no " + name);
  std::vector<CellChange> changes = things_.undoing(thing, map);
  if (!changes.empty()) return changes;
  std::string revisions;
  for (const std::uint32_t revision : found->revisions) revisions += " " + std::to_string(revision);
  throw std::runtime_error("no cell holds any more what " + name +
                           " has written; `undo K` takes its whole revisions:" + revisions);
}

void ThingsKeeper::retry(Timestamp now) {
  if (out_) out_->flush(now);
  if (kept_) kept_->flush(now);
}

void ThingsKeeper::close(Timestamp now) {
  if (out_) out_->close(now);
  if (kept_) kept_->close(now);
}

}  // namespace deltamap::daemon
