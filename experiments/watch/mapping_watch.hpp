// SPDX-License-Identifier: Apache-2.0
// Looks at a mapping drive from the truth's side: what the robot could have seen, how soon the map followed each
// change, what was written wrongly, and how good the map is beside one that is never updated and one that is perfect.
#pragma once

#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "experiments/drive/mapping_drive.hpp"
#include "experiments/scan_table.hpp"
#include "experiments/watch/change_following.hpp"
#include "experiments/watch/error_course.hpp"
#include "experiments/watch/override_map.hpp"
#include "experiments/watch/written_cells.hpp"
#include "simulation/score/change_watch.hpp"
#include "simulation/score/map_truth.hpp"

namespace deltamap::experiments {

struct MappingWatchParams {
  double range_m = 80.0;                ///< as far as the robot sees
  double field_rad = std::numbers::pi;  ///< ahead
  double look_every_s = 0.2;            ///< what is in view, > 0
  double judge_every_s = 1.0;           ///< whether the map has followed, and ghosts, > 0
  double score_every_s = 300.0;
  double wrong_pose_m = 0.3;  ///< cells written while the pose is farther off are counted apart
};

class MappingWatch {
 public:
  MappingWatch(const simulation::Scenario& scenario, std::shared_ptr<const OccupancyGrid> first_map,
               const MappingWatchParams& params);

  void observe(const Mapped& scan, const OccupancyGrid& map);
  /// The daemon has begun again: its localizer checks the pose that was kept before it tracks.
  void restarted() { started_s_ = now_s_; }

  /// Everything that is a number at the end of the drive. `map`: the last.
  using Numbers = std::vector<std::pair<std::string, double>>;
  [[nodiscard]] Numbers numbers(const OccupancyGrid& map);
  /// A row every `score_every_s`.
  [[nodiscard]] const ScanTable& course() const { return course_; }
  [[nodiscard]] const OccupancyGrid& truth() const { return truth_.visible(); }

 private:
  /// Against what a laser can see, over all that has ever been in view.
  struct Scores {
    simulation::score::CellMask seen;
    simulation::score::MapScore ours, stale, perfect;
    simulation::score::MapScore solid;  ///< ours, insides counted
  };
  [[nodiscard]] Scores scores_of(const OccupancyGrid& map) const;
  [[nodiscard]] double shortfall_growth() const;
  [[nodiscard]] Numbers numbers_of_pose() const;
  [[nodiscard]] Numbers numbers_of_following();
  [[nodiscard]] Numbers numbers_of_map(const OccupancyGrid& map, const Scores& scores) const;
  [[nodiscard]] Numbers numbers_of_ghosts() const;
  void count_lost(const Mapped& scan);
  void look(const Mapped& scan);
  void judge_changes(const OccupancyGrid& map);
  [[nodiscard]] bool is_near_someone(const Point2& place) const;
  /// Occupied in the map, nothing stands there, and a beam has gone through since.
  [[nodiscard]] bool is_ghost(const OccupancyGrid& map, Cell cell) const;
  struct Ghosts {
    std::size_t all = 0;
    std::size_t of_passers = 0;  ///< where no container, wall or post has ever stood
  };
  [[nodiscard]] Ghosts ghosts_in(const OccupancyGrid& map) const;
  void count_ghosts(const OccupancyGrid& map);
  /// `map`: after the update.
  void judge_writing(const Mapped& scan, const OccupancyGrid& map);
  void add_course_row(const OccupancyGrid& map);
  void refresh_surfaces();

  MappingWatchParams params_;
  Pose2 robot_from_laser_;
  std::shared_ptr<const OccupancyGrid> first_;
  simulation::score::ChangeWatch changes_;
  simulation::score::MapTruth truth_;
  simulation::Bodies about_;
  OccupancyGrid surfaces_;       // all that stands now, passing things too
  OccupancyGrid ever_surfaces_;  // all that has ever stood in M_0 and the world, without what passes
  ChangeFollowing by_map_;
  ChangeFollowing by_layer_;  // M_k and the transient layer over it
  std::shared_ptr<const TransientObstacles> transients_;
  OverrideMap override_;
  ScanTable course_;
  ErrorCourse errors_;
  std::vector<double> errors_since_row_m_;
  double now_s_ = 0.0;
  double next_look_s_ = 0.0;
  double next_judgement_s_ = 0.0;
  double next_row_s_ = 0.0;
  std::size_t scans_ = 0;
  std::size_t scans_lost_ = 0;            // not tracked, but for those of a start's check
  std::optional<double> started_s_{0.0};  // since when it checks its start pose; nothing once it tracks
  double longest_start_check_s_ = 0.0;
  WrittenCells written_;
  std::size_t ghosts_now_ = 0;
  struct GhostMinutes {  // cell · minutes
    double all = 0.0;
    double of_passers = 0.0;
    void add(const Ghosts& ghosts, double minutes) {
      all += static_cast<double>(ghosts.all) * minutes;
      of_passers += static_cast<double>(ghosts.of_passers) * minutes;
    }
  };
  GhostMinutes ghosts_of_map_, ghosts_of_layer_, ghosts_of_override_;
};

}  // namespace deltamap::experiments
