// SPDX-License-Identifier: Apache-2.0
#include "daemon/tool/experiment/mapping_watch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/near_occupied.hpp"

namespace deltamap::daemon::tool::experiment {
namespace {

namespace score = simulation::score;

constexpr int kViewBeams = 181;
constexpr int kFaceBeams = 3;        // of one view make a face seen
constexpr double kRightShare = 0.8;  // of a written thing's cells
constexpr int kRegionReach = 2;      // cells; written cells so near are one thing
constexpr std::size_t kSpeck = 3;    // smaller regions are not counted as things
constexpr int kGhostReach = 2;       // cells from anything that stands

/// Written cells that are near each other.
std::vector<std::vector<CellChange>> things_of(std::vector<CellChange> left) {
  std::vector<std::vector<CellChange>> things;
  while (!left.empty()) {
    std::vector<CellChange> thing{left.back()};
    left.pop_back();
    for (std::size_t next = 0; next < thing.size(); ++next) {
      const Cell middle = thing[next].cell;
      const auto is_near = [&](const CellChange& other) {
        return std::abs(other.cell.column - middle.column) <= kRegionReach &&
               std::abs(other.cell.row - middle.row) <= kRegionReach;
      };
      const auto first = std::partition(left.begin(), left.end(), [&](const CellChange& c) { return !is_near(c); });
      thing.insert(thing.end(), first, left.end());
      left.erase(first, left.end());
    }
    things.push_back(std::move(thing));
  }
  return things;
}

/// The map as one who knows the temporary layer sees it: what stands occupied, what has gone free.
OccupancyGrid with_things(OccupancyGrid map, const TemporaryThings* things) {
  if (things == nullptr || things->empty()) return map;
  const int side = static_cast<int>(std::lround(things->blocks.resolution_m / map.resolution_m()));
  const auto draw = [&](const std::vector<std::uint32_t>& blocks, CellState state, bool only_occupied) {
    for (const std::uint32_t index : blocks) {
      const Cell block = things->blocks.cell_of(index);
      for (int i = 0; i < side * side; ++i) {
        const Cell cell{block.column * side + i % side, block.row * side + i / side};
        if (!map.geometry().contains(cell)) continue;
        if (!only_occupied || map[cell] == CellState::kOccupied) map.set(cell, state);
      }
    }
  };
  draw(things->gone, CellState::kFree, true);
  draw(things->standing, CellState::kOccupied, false);
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
      writes_(first_->geometry().cell_count(), 0) {
  refresh_surfaces();
}

void MappingWatch::refresh_surfaces() {
  surfaces_ = score::drawn_surfaces(changes_.world_and_standing(), first_->geometry());
  const OccupancyGrid lasting = score::drawn_surfaces(changes_.world(), first_->geometry());
  if (ever_surfaces_.cells().empty()) ever_surfaces_ = *first_;
  for (std::size_t i = 0; i < lasting.cells().size(); ++i) {
    if (lasting.cells()[i] == CellState::kOccupied)
      ever_surfaces_.set(lasting.geometry().cell_of(i), CellState::kOccupied);
  }
}

void MappingWatch::observe(const Mapped& scan, const OccupancyGrid& map) {
  now_s_ = scan.passed_s;
  about_ = scan.about;
  things_ = scan.things;
  for (const simulation::Change& change : scan.changes)
    changes_.apply(change, scan.time, scan.map_from_robot.position());
  for (const simulation::MoverEvent& event : scan.events) changes_.apply(event);
  if (!scan.changes.empty()) truth_.see(changes_.world());
  if (!scan.changes.empty() || !scan.events.empty()) refresh_surfaces();

  ++scans_;
  scans_lost_ += scan.estimate.state == LocalizerState::kTracking ? 0 : 1;
  const double error_m = distance_between(scan.map_from_robot, scan.estimate.map_from_robot);
  errors_.add(scan.time, error_m);
  errors_since_row_m_.push_back(error_m);
  if (scan.update) judge_writing(scan);
  override_.observe(scan.tracked);
  if (now_s_ >= next_look_s_) look(scan);
  if (now_s_ >= next_judgement_s_) {
    next_judgement_s_ += params_.judge_every_s;
    judge_changes(map);
    count_ghosts(map);
  }
  if (now_s_ >= next_row_s_) add_course_row(map);
}

void MappingWatch::look(const Mapped& scan) {
  next_look_s_ += params_.look_every_s;
  const auto view =
      changes_.view_from(scan.map_from_robot * robot_from_laser_, params_.range_m, kViewBeams, about_.surfaces());
  changes_.look(view, params_.look_every_s, kFaceBeams);
  truth_.touch(view);
}

void MappingWatch::judge_changes(const OccupancyGrid& map) {
  by_map_.judge(changes_, map, surfaces_, now_s_);
  by_layer_.judge(changes_, with_things(map, things_.get()), surfaces_, now_s_, &by_map_);
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

bool MappingWatch::is_ghost(const OccupancyGrid& map, std::size_t cell) const {
  return truth_.last_passed()[cell] != 0 && map.cells()[cell] == CellState::kOccupied &&
         !has_occupied_within(surfaces_, map.geometry().cell_of(cell), kGhostReach) &&
         !is_near_someone(map.geometry().centre_of(map.geometry().cell_of(cell)));
}

MappingWatch::Ghosts MappingWatch::ghosts_in(const OccupancyGrid& map) const {
  Ghosts ghosts;
  for (std::size_t i = 0; i < map.cells().size(); ++i) {
    if (!is_ghost(map, i)) continue;
    ++ghosts.all;
    ghosts.of_passers += has_occupied_within(ever_surfaces_, map.geometry().cell_of(i), kGhostReach) ? 0 : 1;
  }
  return ghosts;
}

void MappingWatch::count_ghosts(const OccupancyGrid& map) {
  const double minutes = params_.judge_every_s / 60.0;
  const Ghosts ghosts = ghosts_in(map);
  ghosts_now_ = ghosts.all;
  ghosts_of_map_.add(ghosts, minutes);
  ghosts_of_layer_.add(ghosts_in(with_things(map, things_.get())), minutes);
  ghosts_of_override_.add(ghosts_in(override_.map()), minutes);
}

void MappingWatch::judge_writing(const Mapped& scan) {
  if (!scan.update->revision) {
    ++refused_;
    return;
  }
  ++revisions_;
  const std::vector<CellChange>& changes = scan.update->revision->changes;
  cells_written_ += changes.size();
  const double error_m = std::max(errors_.at_m(scan.time), errors_.at_m(scan.update->note.time));
  if (error_m > params_.wrong_pose_m) cells_written_astray_ += changes.size();
  const OccupancyGrid& truth = truth_.visible();
  const auto is_right = [&](const CellChange& change) {
    if (change.after == CellState::kOccupied) return has_occupied_within(truth, change.cell, 1);
    if (change.after == CellState::kUnknown) return truth[change.cell] != CellState::kFree;
    return truth[change.cell] != CellState::kOccupied;
  };
  for (const CellChange& change : changes) {
    ++writes_[first_->geometry().index_of(change.cell)];
    cells_wrong_ += is_right(change) ? 0 : 1;
  }
  std::vector<CellChange> come;
  std::vector<CellChange> gone;
  for (const CellChange& change : changes) {
    if (truth_.is_at_door(first_->geometry().index_of(change.cell))) continue;  // it comes and goes
    if (change.after == CellState::kOccupied) come.push_back(change);
    if (change.before == CellState::kOccupied && change.after == CellState::kFree) gone.push_back(change);
  }
  for (const auto& side : {come, gone}) {
    for (const std::vector<CellChange>& thing : things_of(side)) {
      if (thing.size() < kSpeck) continue;
      ++regions_;
      const auto right = static_cast<double>(std::count_if(thing.begin(), thing.end(), is_right));
      regions_wrong_ += right < kRightShare * static_cast<double>(thing.size()) ? 1 : 0;
    }
  }
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
               perfect.contour_f1, ours.wrong_m2, static_cast<double>(ghosts_now_), static_cast<double>(revisions_)});
  errors_since_row_m_.clear();
}

std::vector<std::pair<std::string, double>> MappingWatch::numbers(const OccupancyGrid& map) {
  judge_changes(map);
  const ChangeFollowing::Numbers followed = by_map_.numbers(changes_);
  const ChangeFollowing::Numbers layer = by_layer_.numbers(changes_);
  const ChangeFollowing::Numbers layer_added = by_layer_.numbers(changes_, ChangeFollowing::Which::kAppeared);
  const ChangeFollowing::Numbers layer_gone = by_layer_.numbers(changes_, ChangeFollowing::Which::kDisappeared);
  const auto [seen, ours, stale, perfect, solid] = scores_of(map);
  const score::MapScore solid_perfect = score::map_score(truth_.solid(), truth_.perfect(), seen);
  double drift_m = 0.0;
  for (const double wall_m : truth_.wall_drift(*first_, map))
    if (std::isfinite(wall_m)) drift_m = std::max(drift_m, std::abs(wall_m));
  std::size_t seen_cells = 0;
  std::uint16_t most_writes = 0;
  std::size_t writes = 0;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (seen[i] == 0) continue;
    ++seen_cells;
    writes += writes_[i];
    most_writes = std::max(most_writes, writes_[i]);
  }
  const double hours = std::max(now_s_, 1.0) / 3600.0;
  const auto whole = [](std::size_t number) { return static_cast<double>(number); };
  const auto share = [&](std::size_t part, std::size_t all) {
    return all == 0 ? std::numeric_limits<double>::quiet_NaN() : whole(part) / whole(all);
  };
  return {{"minutes", now_s_ / 60.0},
          {"error_mean_m", mean_of(errors_.all_m())},
          {"error_rms_m", root_mean_square(errors_.all_m())},
          {"error_p99_m", quantile(errors_.all_m(), 0.99)},
          {"error_most_m", quantile(errors_.all_m(), 1.0)},
          {"not_tracking", share(scans_lost_, scans_)},
          {"changes_seen_10s", whole(followed.seen)},
          {"changes_found", whole(followed.found)},
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
          {"layer_gone_within_10s", layer_gone.within_10s},
          {"things_written", whole(regions_)},
          {"precision", 1.0 - share(regions_wrong_, regions_)},
          {"cells_written", whole(cells_written_)},
          {"cells_wrong", share(cells_wrong_, cells_written_)},
          {"cells_written_astray", whole(cells_written_astray_)},
          {"revisions", whole(revisions_)},
          {"refused", whole(refused_)},
          {"acceptance", ours.acceptance},
          {"acceptance_stale", stale.acceptance},
          {"acceptance_perfect", perfect.acceptance},
          {"acceptance_solid", solid.acceptance},
          {"acceptance_solid_perfect", solid_perfect.acceptance},
          {"f1", ours.contour_f1},
          {"f1_stale", stale.contour_f1},
          {"f1_perfect", perfect.contour_f1},
          {"skill", score::skill(ours.contour_f1, stale.contour_f1, perfect.contour_f1)},
          {"wrong_m2", ours.wrong_m2},
          {"walls_kept", score::share_kept(*first_, map, truth_.lasting())},
          {"glass_and_wrap_kept", score::share_kept(*first_, map, truth_.seen_through())},
          {"wall_drift_m", drift_m},
          {"writes_per_cell_hour", share(writes, seen_cells) / hours},
          {"most_writes_of_a_cell", static_cast<double>(most_writes)},
          {"ghost_cells_at_end", whole(ghosts_now_)},
          {"ghost_cell_minutes", ghosts_of_map_.all},
          {"ghost_cell_minutes_layer", ghosts_of_layer_.all},
          {"ghost_cell_minutes_override", ghosts_of_override_.all},
          {"passer_ghost_minutes", ghosts_of_map_.of_passers},
          {"passer_ghost_minutes_layer", ghosts_of_layer_.of_passers},
          {"passer_ghost_minutes_override", ghosts_of_override_.of_passers},
          {"passer_ghosts_of_override", ghosts_of_map_.of_passers / std::max(1e-9, ghosts_of_override_.of_passers)}};
}

}  // namespace deltamap::daemon::tool::experiment
