// SPDX-License-Identifier: Apache-2.0
#include "daemon/replay/replay_output.hpp"

#include "core/files/grid_file.hpp"
#include "daemon/maps/revision_keeper.hpp"
#include "daemon/maps/stored_things.hpp"
#include "daemon/outputs/bay_note.hpp"
#include "daemon/outputs/thing_note.hpp"

namespace deltamap::daemon {

FolderOutput::FolderOutput(const std::filesystem::path& folder, const OccupancyGrid& first,
                           std::uint32_t first_revision, const mapping::things::ThingsParams& things)
    : folder_{folder},
      first_revision_{first_revision},
      store_{folder / "map_store.sqlite", first},
      trajectory_{folder / "trajectory.tum"},
      localization_log_{folder / "localization.csv"},
      changes_{folder / "changes.jsonl"},
      told_things_{folder / "things.jsonl"},
      told_bays_{folder / "bays.jsonl"},
      things_{things} {
  localization_log_.write(csv_header());
}

void FolderOutput::localized(const LocalizationRow& row) {
  trajectory_.write(tum_line({row.time, row.map_from_robot}));
  localization_log_.write(csv_line(row));
}

void FolderOutput::passed_over(const TrajectoryPoint& point) { trajectory_.write(tum_line(point)); }

void FolderOutput::changed(const MapStep::Result& result, std::string_view method) {
  changes_.write(json_line(result.note));
  keep(store_, result, method, first_revision_);
  for (const auto& event : take_result(things_, result)) told_things_.write(json_line(event));
}

void FolderOutput::told(const mapping::bays::BayEvent& event) { told_bays_.write(json_line(event, things_.all())); }

void FolderOutput::look(const TrackedScan& tracked) {
  for (const auto& event : things_.look(tracked)) told_things_.write(json_line(event));
}

void FolderOutput::settled() { store_.set_provisional({}); }

void FolderOutput::finish(const OccupancyGrid& newest) {
  trajectory_.flush();
  localization_log_.flush();
  changes_.flush();
  told_things_.flush();
  told_bays_.flush();
  write_grid(newest, folder_ / "map.yaml");
}

}  // namespace deltamap::daemon
