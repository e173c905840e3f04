// SPDX-License-Identifier: Apache-2.0
// Where the lines and revisions of a replay go: into the files of --out, or wherever else they are made use of.
#pragma once

#include <filesystem>
#include <string_view>

#include "core/grid/occupancy_grid.hpp"
#include "daemon/outputs/line_file.hpp"
#include "daemon/outputs/localization_log.hpp"
#include "daemon/outputs/outputs.hpp"
#include "daemon/steps/map_step.hpp"
#include "mapping/bays/bays.hpp"
#include "mapping/store/map_store.hpp"
#include "mapping/things/things.hpp"

namespace deltamap::daemon {

class ReplayOutput {
 public:
  virtual ~ReplayOutput() = default;
  /// A scan that was localized.
  virtual void localized(const LocalizationRow& row) = 0;
  /// A scan that a newer one had overtaken: where the wheels say that it was taken.
  virtual void passed_over(const TrajectoryPoint& point) = 0;
  /// What became of a Δ-phase or of an operator's order. `method` as MapStep has it.
  virtual void changed(const MapStep::Result& result, std::string_view method) = 0;
  /// A bay's state is another one.
  virtual void told(const mapping::bays::BayEvent& event) = 0;
  /// A scan that is held against what is assumed of things.
  virtual void look(const TrackedScan& tracked) = 0;
  /// No revision is provisional any more.
  virtual void settled() = 0;
  /// The end, with the newest map.
  virtual void finish(const OccupancyGrid& newest) = 0;
};

/// The files of --out but report.json. Throws std::runtime_error that names the file.
class FolderOutput : public ReplayOutput {
 public:
  /// `first_revision`: the number of the map that the run starts on.
  FolderOutput(const std::filesystem::path& folder, const OccupancyGrid& first, std::uint32_t first_revision,
               const mapping::things::ThingsParams& things = {});

  void localized(const LocalizationRow& row) override;
  void passed_over(const TrajectoryPoint& point) override;
  void changed(const MapStep::Result& result, std::string_view method) override;
  void told(const mapping::bays::BayEvent& event) override;
  void look(const TrackedScan& tracked) override;
  void settled() override;
  void finish(const OccupancyGrid& newest) override;

 private:
  std::filesystem::path folder_;
  std::uint32_t first_revision_;
  mapping::store::MapStore store_;
  LineFile trajectory_;
  LineFile localization_log_;
  LineFile changes_;
  LineFile told_things_;
  LineFile told_bays_;
  mapping::things::Things things_;
};

}  // namespace deltamap::daemon
