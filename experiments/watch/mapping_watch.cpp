// SPDX-License-Identifier: Apache-2.0
#include "experiments/watch/mapping_watch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/grid/near_occupied.hpp"

namespace deltamap::experiments {
namespace {

namespace score = simulation::score;

constexpr double kLongestStartCheck_s = 5.0;  // who is undecided for longer has lost his way
constexpr int kViewBeams = 181;
constexpr int kFaceBeams = 3;   // of one view make a face seen
constexpr int kGhostReach = 2;  // cells from anything that stands
constexpr std::size_t kLeastRowsOfALine = 3;

/// The map as one who knows the transient layer sees it: what stands occupied, what has gone free.
OccupancyGrid with_transients(OccupancyGrid map, const TransientObstacles* transients) {
  if (transients == nullptr || transients->empty()) return map;
  const int side = static_cast<int>(std::lround(transients->blocks.resolution_m / map.resolution_m()));
  const auto draw = [&](const std::vector<std::uint32_t>& blocks, CellState state, bool only_occupied) {
    for (const std::uint32_t index : blocks) {
      const Cell block = transients->blocks.cell_of(index);
      for (int i = 0; i < side * side; ++i) {
        const Cell cell{block.column * side + i % side, block.row * side + i / side};
        if (!map.geometry().contains(cell)) continue;
        if (!only_occupied || map[cell] == CellState::kOccupied) map.set(cell, state);
      }
    }
  };
  draw(transients->gone, CellState::kFree, true);
  draw(transients->standing, CellState::kOccupied, false);
  return map;
}

}  // namespace

MappingWatch::MappingWatch(const simulation::Scenario& scenario, std::shared_ptr<const OccupancyGrid> first_map,
                           const MappingWatchParams& params)
    : params_{params},
      robot_from_laser_{scenario.laser.optics.robot_from_laser},
      first_{std::move(first_map)},
      changes_{scenario, first_->geometry()},
      truth_{scenario, *first_},
      override_{*first_},
      course_{{"t_s", "error_mean_m", "error_most_m", "acceptance", "acceptance_stale", "acceptance_perfect",
               "acceptance_solid", "f1", "f1_stale", "f1_perfect", "wrong_m2", "ghost_cells", "revisions"}},
      next_row_s_{params.score_every_s},
      written_{first_->geometry()} {
  refresh_surfaces();
}

void MappingWatch::refresh_surfaces() {
  surfaces_ = score::drawn_surfaces(changes_.world_and_standing(), first_->geometry());
  const OccupancyGrid lasting = score::drawn_surfaces(changes_.world(), first_->geometry());
  if (ever_surfaces_.box().empty()) ever_surfaces_ = *first_;
  for_each_known(lasting, [&](Cell cell, CellState state) {
    if (state == CellState::kOccupied) ever_surfaces_.set(cell, CellState::kOccupied);
  });
}

void MappingWatch::observe(const Mapped& scan, const OccupancyGrid& map) {
  now_s_ = scan.passed_s;
  about_ = scan.about;
  transients_ = scan.transients;
  for (const simulation::Change& change : scan.changes)
    changes_.apply(change, scan.time, scan.map_from_robot.position());
  for (const simulation::MoverEvent& event : scan.events) changes_.apply(event);
  if (!scan.changes.empty()) truth_.see(changes_.world());
  if (!scan.changes.empty() || !scan.events.empty()) refresh_surfaces();

  count_lost(scan);
  const double error_m = distance_between(scan.map_from_robot, scan.estimate.map_from_robot);
  errors_.add(scan.time, error_m);
  errors_since_row_m_.push_back(error_m);
  if (scan.update) judge_writing(scan, map);
  override_.observe(scan.tracked);
  if (now_s_ >= next_look_s_) look(scan);
  if (now_s_ >= next_judgement_s_) {
    next_judgement_s_ += params_.judge_every_s;
    judge_changes(map);
    count_ghosts(map);
  }
  if (now_s_ >= next_row_s_) add_course_row(map);
}

void MappingWatch::count_lost(const Mapped& scan) {
  ++scans_;
  const bool is_tracking = scan.estimate.state == LocalizerState::kTracking;
  if (started_s_) longest_start_check_s_ = std::max(longest_start_check_s_, now_s_ - *started_s_);
  if (is_tracking) started_s_.reset();
  const bool checks_start = started_s_ && now_s_ - *started_s_ < kLongestStartCheck_s;
  scans_lost_ += is_tracking || checks_start ? 0 : 1;
}

void MappingWatch::look(const Mapped& scan) {
  next_look_s_ += params_.look_every_s;
  const auto view = changes_.view_from(scan.map_from_robot * robot_from_laser_, params_.range_m, kViewBeams,
                                       about_.surfaces(), params_.field_rad);
  changes_.look(view, params_.look_every_s, kFaceBeams);
  truth_.touch(view);
}

void MappingWatch::judge_changes(const OccupancyGrid& map) {
  by_map_.judge(changes_, map, surfaces_, now_s_);
  by_layer_.judge(changes_, with_transients(map, transients_.get()), surfaces_, now_s_, &by_map_);
}

bool MappingWatch::is_near_someone(const Point2& place) const {
  const double near_m = (kGhostReach + 1) * first_->resolution_m();
  const simulation::MovingSurfaces surfaces = about_.surfaces();
  return std::any_of(
             surfaces.round.begin(), surfaces.round.end(),
             [&](const simulation::Circle& one) { return (one.centre - place).norm() < one.radius_m + near_m; }) ||
         std::any_of(surfaces.straight.begin(), surfaces.straight.end(),
                     [&](const simulation::Segment& one) { return distance_between(place, one) < near_m; });
}

bool MappingWatch::is_ghost(const OccupancyGrid& map, Cell cell) const {
  return truth_.last_passed()[map.geometry().index_of(cell)] != 0 && map[cell] == CellState::kOccupied &&
         !has_occupied_within(surfaces_, cell, kGhostReach) && !is_near_someone(map.geometry().centre_of(cell));
}

MappingWatch::Ghosts MappingWatch::ghosts_in(const OccupancyGrid& map) const {
  Ghosts ghosts;
  for_each_known(map, [&](Cell cell, CellState) {
    if (!is_ghost(map, cell)) return;
    ++ghosts.all;
    ghosts.of_passers += has_occupied_within(ever_surfaces_, cell, kGhostReach) ? 0 : 1;
  });
  return ghosts;
}

void MappingWatch::count_ghosts(const OccupancyGrid& map) {
  const double minutes = params_.judge_every_s / 60.0;
  const Ghosts ghosts = ghosts_in(map);
  ghosts_now_ = ghosts.all;
  ghosts_of_map_.add(ghosts, minutes);
  ghosts_of_layer_.add(ghosts_in(with_transients(map, transients_.get())), minutes);
  ghosts_of_override_.add(ghosts_in(override_.map()), minutes);
}

void MappingWatch::judge_writing(const Mapped& scan, const OccupancyGrid& map) {
  if (!scan.update->revision) {
    written_.note_refused();
    return;
  }
  const std::vector<CellChange>& changes = scan.update->revision->changes;
  if (!scan.update->note.withdraws.empty()) {
    written_.observe_withdrawal(changes);
    return;
  }
  const double error_m = std::max(errors_.at_m(scan.time), errors_.at_m(scan.update->note.time));
  written_.observe({changes, map, error_m > params_.wrong_pose_m}, truth_, surfaces_);
}

MappingWatch::Scores MappingWatch::scores_of(const OccupancyGrid& map) const {
  const score::CellMask seen = truth_.seen();
  return {seen, score::map_score(truth_.visible(), map, seen), score::map_score(truth_.visible(), *first_, seen),
          score::map_score(truth_.visible(), truth_.perfect(), seen), score::map_score(truth_.solid(), map, seen)};
}

void MappingWatch::add_course_row(const OccupancyGrid& map) {
  next_row_s_ += params_.score_every_s;
  const auto [seen, ours, stale, perfect, solid] = scores_of(map);
  course_.add({now_s_, mean_of(errors_since_row_m_), quantile(errors_since_row_m_, 1.0), ours.acceptance,
               stale.acceptance, perfect.acceptance, solid.acceptance, ours.contour_f1, stale.contour_f1,
               perfect.contour_f1, ours.wrong_m2, static_cast<double>(ghosts_now_),
               static_cast<double>(written_.revisions())});
  errors_since_row_m_.clear();
}

/// How much more the map falls short of a perfect one at the end than in the beginning, by the line that fits best.
double MappingWatch::shortfall_growth() const {
  const std::vector<double> time_s = course_.column("t_s");
  const std::vector<double> ours = course_.column("acceptance");
  const std::vector<double> perfect = course_.column("acceptance_perfect");
  if (time_s.size() < kLeastRowsOfALine) return std::numeric_limits<double>::quiet_NaN();
  const double middle_s = mean_of(time_s);
  double moment = 0.0;
  double spread = 0.0;
  for (std::size_t row = 0; row < time_s.size(); ++row) {
    moment += (time_s[row] - middle_s) * (perfect[row] - ours[row]);
    spread += (time_s[row] - middle_s) * (time_s[row] - middle_s);
  }
  return moment / spread * (time_s.back() - time_s.front());
}

MappingWatch::Numbers MappingWatch::numbers_of_pose() const {
  const auto scans = static_cast<double>(std::max<std::size_t>(1, scans_));
  return {{"minutes", now_s_ / 60.0},
          {"error_mean_m", mean_of(errors_.all_m())},
          {"error_rms_m", root_mean_square(errors_.all_m())},
          {"error_p99_m", quantile(errors_.all_m(), 0.99)},
          {"error_most_m", quantile(errors_.all_m(), 1.0)},
          {"not_tracking", static_cast<double>(scans_lost_) / scans},
          {"longest_start_check_s", longest_start_check_s_}};
}

MappingWatch::Numbers MappingWatch::numbers_of_following() {
  const ChangeFollowing::Numbers followed = by_map_.numbers(changes_);
  const ChangeFollowing::Numbers layer = by_layer_.numbers(changes_);
  const ChangeFollowing::Numbers layer_added = by_layer_.numbers(changes_, ChangeFollowing::Which::kAppeared);
  const ChangeFollowing::Numbers layer_gone = by_layer_.numbers(changes_, ChangeFollowing::Which::kDisappeared);
  return {{"changes_seen_10s", static_cast<double>(followed.seen)},
          {"changes_found", static_cast<double>(followed.found)},
          {"recall", followed.recall},
          {"follow_median_s", followed.median_s},
          {"follow_p90_s", followed.p90_s},
          {"follow_clock_median_s", followed.clock_median_s},
          {"layer_recall", layer.recall},
          {"layer_median_s", layer.median_s},
          {"layer_p90_s", layer.p90_s},
          {"layer_added_recall", layer_added.recall},
          {"layer_added_median_s", layer_added.median_s},
          {"layer_gone_recall", layer_gone.recall},
          {"layer_gone_median_s", layer_gone.median_s},
          {"layer_gone_within_10s", layer_gone.within_10s}};
}

MappingWatch::Numbers MappingWatch::numbers_of_map(const OccupancyGrid& map, const Scores& scores) const {
  const auto& [seen, ours, stale, perfect, solid] = scores;
  double drift_m = 0.0;
  for (const double wall_m : truth_.wall_drift(*first_, map))
    if (std::isfinite(wall_m)) drift_m = std::max(drift_m, std::abs(wall_m));
  return {{"acceptance", ours.acceptance},
          {"acceptance_stale", stale.acceptance},
          {"acceptance_perfect", perfect.acceptance},
          {"shortfall_growth", shortfall_growth()},
          {"acceptance_solid", solid.acceptance},
          {"acceptance_solid_perfect", score::map_score(truth_.solid(), truth_.perfect(), seen).acceptance},
          {"f1", ours.contour_f1},
          {"f1_stale", stale.contour_f1},
          {"f1_perfect", perfect.contour_f1},
          {"skill", score::skill(ours.contour_f1, stale.contour_f1, perfect.contour_f1)},
          {"wrong_m2", ours.wrong_m2},
          {"walls_kept", score::share_kept(*first_, map, truth_.lasting())},
          {"glass_and_wrap_kept", score::share_kept(*first_, map, truth_.seen_through())},
          {"wall_drift_m", drift_m}};
}

MappingWatch::Numbers MappingWatch::numbers_of_ghosts() const {
  return {{"ghost_cells_at_end", static_cast<double>(ghosts_now_)},
          {"ghost_cell_minutes", ghosts_of_map_.all},
          {"ghost_cell_minutes_layer", ghosts_of_layer_.all},
          {"ghost_cell_minutes_override", ghosts_of_override_.all},
          {"passer_ghost_minutes", ghosts_of_map_.of_passers},
          {"passer_ghost_minutes_layer", ghosts_of_layer_.of_passers},
          {"passer_ghost_minutes_override", ghosts_of_override_.of_passers},
          {"passer_ghosts_of_override", ghosts_of_map_.of_passers / std::max(1e-9, ghosts_of_override_.of_passers)}};
}

MappingWatch::Numbers MappingWatch::numbers(const OccupancyGrid& map) {
  judge_changes(map);
  const Scores scores = scores_of(map);
  Numbers all;
  for (const Numbers& some :
       {numbers_of_pose(), numbers_of_following(), written_.numbers(scores.seen, std::max(now_s_, 1.0) / 3600.0),
        numbers_of_map(map, scores), numbers_of_ghosts()}) {
    all.insert(all.end(), some.begin(), some.end());
  }
  return all;
}

}  // namespace deltamap::experiments
