// SPDX-License-Identifier: Apache-2.0
// Why votes on blocks: the fit of a whole scan does not notice a box half a metre wide, and does not say where it
// stands. Blocks are wider than a pose's error of some centimetres, and votes have to last because people, trolleys
// and doors only pass.
#include "mapping/evidence/evidence_phase.hpp"

#include <algorithm>
#include <utility>

namespace deltamap::mapping::evidence {
namespace {

constexpr std::uint32_t kFewestExpected = 3;  // beams that the map expects something of

/// The pose says where the ground lies that was known before.
bool tells_of_known_ground(const Belief& belief) {
  return !belief.is_on_new_ground && belief.stable.expected + belief.elsewhere.expected >= kFewestExpected;
}

constexpr votes::Question kQuestions[] = {votes::Question::kAdded, votes::Question::kRemoved};

void sort_unique(std::vector<std::uint32_t>& indices) {
  std::sort(indices.begin(), indices.end());
  indices.erase(std::unique(indices.begin(), indices.end()), indices.end());
}

}  // namespace

EvidencePhase::EvidencePhase(const EvidencePhaseParams& params)
    : params_{params}, keyframes_{params.keyframes}, small_objects_{params.small_objects} {}

bool EvidencePhase::is_proven(votes::Question question, Cell block) const {
  const votes::Ballot ballot = layer_.ballot(question, block, now_ms_);
  const bool is_changed_this_run =
      question == votes::Question::kRemoved && changed_this_run_.is_changed_this_run(block);
  const double least_span_s = is_changed_this_run ? params_.changed_this_run_persistence_s : params_.face_persistence_s;
  return ballot.yes >= static_cast<float>(params_.least_votes) && ballot.span_s() >= least_span_s &&
         ballot.share() >= params_.least_share;
}

/// Votes were cast against the map of their time: where it has changed they are void.
void EvidencePhase::take_map(std::shared_ptr<const OccupancyGrid> map) {
  if (map == map_) return;
  const std::shared_ptr<const OccupancyGrid> before = std::exchange(map_, std::move(map));
  if (before == nullptr) begun_with_ = map_;
  if (before == nullptr || before->geometry() != map_->geometry()) {
    small_objects_.begin(*map_);
    layer_ = votes::VoteLayer{params_.votes, map_->geometry()};
    transients_ = TransientLayer{params_.temporary, layer_.lattice()};
    waiting_.clear();
    clear_ = votes::ClearSpace{*map_, layer_.lattice()};
    redraw_queue_ = votes::RedrawQueue{params_.redraw_queue, layer_.blocks()};
    joined_ = Tiled<std::uint8_t>{layer_.blocks().width, layer_.blocks().height, 0};
    passing_ = Passing{params_.passing};
    changed_this_run_ = votes::ChangedThisRun{clear_};
    return;
  }
  const std::vector<CellChange> changes = changes_between(*before, *map_);
  for (const CellChange& change : changes) {
    layer_.reset(grown({change.cell, {change.cell.column + 1, change.cell.row + 1}}, 1, map_->geometry()));
  }
  small_objects_.follow(*map_, changes);
  clear_.update(*map_, changes);
  changed_this_run_.follow(clear_, changes);
  transients_.follow(*map_);
}

void EvidencePhase::count_beams() {
  for (const votes::BeamVerdict& beam : beams_) {
    short_beams_ += beam.ends_off_map ? 1 : 0;
    through_beams_ += beam.passed.empty() ? 0 : 1;
  }
}

/// A pose that rests on what this run has drawn may have drifted away from the ground that was known before.
const votes::Votes& EvidencePhase::without_known_ground(const votes::Votes& votes) {
  votes::Votes& left = votes_on_new_ground_;
  for (const std::size_t i : {std::size_t{0}, std::size_t{1}}) {
    left.yes[i] = votes.yes[i];
    left.no[i] = votes.no[i];
  }
  left.ends = votes.ends;
  left.all = votes.all;
  const auto is_known = [this](std::uint32_t index) {
    const CellBox cells = layer_.cells_of(layer_.blocks().cell_of(index));
    for (int row = cells.first.row; row < cells.last.row; ++row) {
      for (int column = cells.first.column; column < cells.last.column; ++column) {
        if (was_known({column, row})) return true;
      }
    }
    return false;
  };
  for (votes::Blocks* blocks : {&left.yes[0], &left.yes[1], &left.no[0], &left.no[1], &left.ends, &left.all})
    std::erase_if(*blocks, is_known);
  return left;
}

bool EvidencePhase::is_unwritten(Cell cell) const { return unwritten_.covers(map_->geometry().centre_of(cell)); }

/// A block counts by its middle; of one on the border single cells are left out when it is written.
const votes::Votes& EvidencePhase::without_unwritten_ground(const votes::Votes& votes) {
  if (unwritten_.empty()) return votes;
  votes::Votes& left = votes_on_written_ground_;
  left = votes;
  const auto is_left_out = [this](std::uint32_t index) {
    return unwritten_.covers(layer_.blocks().centre_of(layer_.blocks().cell_of(index)));
  };
  for (votes::Blocks* blocks : {&left.yes[0], &left.yes[1], &left.no[0], &left.no[1], &left.ends})
    std::erase_if(*blocks, is_left_out);
  return left;
}

bool EvidencePhase::was_known(Cell cell) const {
  return begun_with_->at(begun_with_->geometry().cell_at(map_->geometry().centre_of(cell))) != CellState::kUnknown;
}

void EvidencePhase::cast(const votes::Votes& votes) {
  for (const votes::Question question : kQuestions) {
    const auto i = static_cast<std::size_t>(question);
    for (const std::uint32_t index : votes.no[i]) layer_.vote(question, layer_.blocks().cell_of(index), false, now_ms_);
    for (const std::uint32_t index : votes.yes[i]) {
      const Cell block = layer_.blocks().cell_of(index);
      layer_.vote(question, block, true, now_ms_);
      const bool is_waiting = std::any_of(waiting_.begin(), waiting_.end(), [&](const ProvenBlock& proven) {
        return proven.question == question && proven.block == block;
      });
      if (!is_waiting && is_proven(question, block)) waiting_.push_back({question, block, now_ms_});
    }
  }
}

/// The region and, from neighbour to neighbour, what has been voted for beside it: a thing comes and goes as a whole.
std::vector<Cell> EvidencePhase::with_joining_blocks(const std::vector<ProvenBlock>& region) {
  const GridGeometry& blocks = layer_.blocks();
  const votes::Question question = region.front().question;
  const double least_votes = question == votes::Question::kAdded ? params_.joining_votes : params_.joining_gone_votes;
  std::vector<Cell> joined;
  const auto join = [&](Cell block) {
    if (std::exchange(joined_.to_write(block), 1) == 0) joined.push_back(block);
  };
  const auto is_voted_for = [&](Cell block) {
    const votes::Ballot ballot = layer_.ballot(question, block, now_ms_);
    return ballot.yes >= static_cast<float>(least_votes) && ballot.share() >= params_.least_share;
  };
  for (const ProvenBlock& proven : region) join(proven.block);
  std::size_t next = 0;
  while (next < joined.size()) {
    const Cell middle = joined[next++];
    for (int row = -params_.reach_blocks; row <= params_.reach_blocks; ++row) {
      for (int column = -params_.reach_blocks; column <= params_.reach_blocks; ++column) {
        const Cell block{middle.column + column, middle.row + row};
        if (blocks.contains(block) && is_voted_for(block)) join(block);
      }
    }
  }
  for (const Cell& block : joined) joined_.to_write(block) = 0;
  return joined;
}

void EvidencePhase::add_verdicts(votes::Question question, Cell block, std::vector<CellVerdict>& verdicts) const {
  const CellBox cells = layer_.cells_of(block);
  for (int row = cells.first.row; row < cells.last.row; ++row) {
    for (int column = cells.first.column; column < cells.last.column; ++column) {
      const Cell cell{column, row};
      if (!map_->geometry().contains(cell)) continue;
      const bool occupied = (*map_)[cell] == CellState::kOccupied;
      if (question == votes::Question::kRemoved && occupied) verdicts.push_back({cell, CellState::kFree});
      if (question == votes::Question::kAdded && !occupied) verdicts.push_back({cell, CellState::kOccupied});
    }
  }
}

/// Were the map update to refuse, the block has to be proven again.
void EvidencePhase::begin_anew(votes::Question question, Cell block) {
  layer_.reset(question, block);
  std::erase_if(waiting_,
                [&](const ProvenBlock& proven) { return proven.question == question && proven.block == block; });
}

std::optional<ScanSet> EvidencePhase::with_scans(ScanSet set, const votes::Blocks& blocks, std::uint32_t first_ms) {
  if (!unwritten_.empty()) std::erase_if(set.verdicts, [this](const CellVerdict& v) { return is_unwritten(v.cell); });
  if (leaves_known_ground_) std::erase_if(set.verdicts, [this](const CellVerdict& v) { return was_known(v.cell); });
  if (set.verdicts.empty()) return std::nullopt;
  set.phase = phase_ + 1;
  set.began = set.ended - std::chrono::milliseconds{now_ms_ - first_ms};  // holds where the count has wrapped
  set.scans = keyframes_.that_saw(blocks, set.began);
  if (set.scans.empty()) return std::nullopt;
  phase_ = set.phase;
  return set;
}

KeptScans EvidencePhase::scans_of_waiting() const {
  votes::Blocks blocks;
  std::uint32_t first_ms = now_ms_;
  for (const ProvenBlock& proven : waiting_) {
    blocks.push_back(static_cast<std::uint32_t>(layer_.blocks().index_of(proven.block)));
    first_ms = std::min(first_ms, layer_.ballot(proven.question, proven.block, now_ms_).first_ms);
  }
  if (blocks.empty()) return {};
  return keyframes_.that_saw(blocks, *start_ + std::chrono::milliseconds{first_ms});
}

/// Smaller regions are noise, but what is gone may have been small.
bool EvidencePhase::is_large_enough(const std::vector<ProvenBlock>& region) const {
  if (region.size() >= params_.least_blocks) return true;
  if (region.front().question == votes::Question::kAdded) return false;
  return std::all_of(region.begin(), region.end(), [&](const ProvenBlock& proven) {
    std::vector<CellVerdict> gone;
    add_verdicts(proven.question, proven.block, gone);
    return std::all_of(gone.begin(), gone.end(),
                       [&](const CellVerdict& v) { return small_objects_.is_of_small_object(v.cell); });
  });
}

/// Most of what is to be drawn lies where nothing was known.
bool EvidencePhase::is_new_ground(const std::vector<ProvenBlock>& region) const {
  if (region.front().question == votes::Question::kRemoved) return false;
  std::vector<CellVerdict> drawn;
  for (const ProvenBlock& proven : region) add_verdicts(proven.question, proven.block, drawn);
  const auto unknown = std::count_if(drawn.begin(), drawn.end(), [this](const CellVerdict& verdict) {
    return (*map_)[verdict.cell] == CellState::kUnknown;
  });
  return 2 * static_cast<std::size_t>(unknown) > drawn.size();
}

bool EvidencePhase::is_settled(const std::vector<ProvenBlock>& region) const {
  const auto [oldest, newest] = std::minmax_element(
      region.begin(), region.end(), [](const ProvenBlock& a, const ProvenBlock& b) { return a.since_ms < b.since_ms; });
  const double unchanged_s = 1e-3 * (now_ms_ - newest->since_ms);
  return unchanged_s >= params_.settle_s || 1e-3 * (now_ms_ - oldest->since_ms) >= params_.most_wait_s ||
         (unchanged_s >= params_.draws_at_once_s && is_new_ground(region));
}

/// Something that this run itself has written is gone.
bool EvidencePhase::is_changed_this_run(const std::vector<ProvenBlock>& region) const {
  return region.front().question == votes::Question::kRemoved &&
         std::all_of(region.begin(), region.end(),
                     [&](const ProvenBlock& one) { return changed_this_run_.is_changed_this_run(one.block); });
}

/// Beams from afar pass but a part of somebody who stood there, or of what is left of a wall: it goes as a whole.
void EvidencePhase::add_remains(std::vector<CellVerdict>& gone, votes::Blocks& blocks) const {
  std::vector<Cell> cells;
  for (const CellVerdict& verdict : gone) {
    if (small_objects_.is_of_small_object(verdict.cell)) cells.push_back(verdict.cell);
  }
  for (const Cell& cell : small_objects_.whole(cells)) {
    if (std::find(cells.begin(), cells.end(), cell) != cells.end()) continue;
    gone.push_back({cell, CellState::kFree});
    blocks.push_back(static_cast<std::uint32_t>(layer_.blocks().index_of(layer_.block_of(cell))));
  }
}

EvidencePhase::Handed EvidencePhase::hand_on(const std::vector<ProvenBlock>& region,
                                             std::vector<CellVerdict>& verdicts) {
  const votes::Question question = region.front().question;
  Handed handed{.blocks = {}, .first_ms = now_ms_};
  std::vector<CellVerdict> own;
  for (const Cell& block : with_joining_blocks(region)) {
    handed.first_ms = std::min(handed.first_ms, layer_.ballot(question, block, now_ms_).first_ms);
    add_verdicts(question, block, own);
    handed.blocks.push_back(static_cast<std::uint32_t>(layer_.blocks().index_of(block)));
    passing_.note(handed.blocks.back(), question, now_ms_);
    begin_anew(question, block);
  }
  if (question == votes::Question::kRemoved) add_remains(own, handed.blocks);
  verdicts.insert(verdicts.end(), own.begin(), own.end());
  sort_unique(handed.blocks);
  return handed;
}

/// Keyframes from before a thing went would draw it again: what was freed counts from now on. Who has come and gone
/// within this run passes: his place is not looked at again.
void EvidencePhase::keep_in_view(const std::vector<ProvenBlock>& region, const Handed& handed) {
  if (is_changed_this_run(region)) {
    redraw_queue_.forget(handed.blocks);
  } else if (region.front().question == votes::Question::kRemoved) {
    redraw_queue_.begin_anew(handed.blocks, now_ms_);
    redraw_queue_.watch(handed.blocks, 0, now_ms_);
  } else {
    redraw_queue_.watch(handed.blocks, params_.reach_blocks, handed.first_ms);
  }
}

std::optional<ScanSet> EvidencePhase::settled_regions(Timestamp time) {
  std::erase_if(waiting_, [&](const ProvenBlock& proven) { return !is_proven(proven.question, proven.block); });
  ScanSet set;
  set.ended = time;
  votes::Blocks handed_on;
  std::uint32_t first_ms = now_ms_;
  for (const std::vector<ProvenBlock>& region : connected_regions(waiting_, params_.reach_blocks)) {
    if (!is_settled(region) || !is_large_enough(region)) continue;
    if (!is_changed_this_run(region) && passing_.is_passing(region, {*map_, layer_, now_ms_})) continue;
    const Handed handed = hand_on(region, set.verdicts);
    keep_in_view(region, handed);
    first_ms = std::min(first_ms, handed.first_ms);
    handed_on.insert(handed_on.end(), handed.blocks.begin(), handed.blocks.end());
  }
  sort_unique(handed_on);
  return with_scans(std::move(set), handed_on, first_ms);
}

/// What was written from a few keyframes is drawn again, more sharply, once many more have seen it. It only gains: a
/// glance from afar must not wipe out what was drawn from nearby.
std::optional<ScanSet> EvidencePhase::another_look(Timestamp time) {
  const std::optional<votes::Look> look = redraw_queue_.due_look();
  if (!look) return std::nullopt;
  ScanSet set;
  set.ended = time;
  if (!look->is_last) set.least_changes = params_.least_look_cells;
  for (const std::uint32_t index : look->blocks) {
    add_verdicts(votes::Question::kAdded, layer_.blocks().cell_of(index), set.verdicts);
  }
  return with_scans(std::move(set), look->blocks, look->first_ms);
}

std::optional<ScanSet> EvidencePhase::observe(const TrackedScan& tracked) {
  const Estimate& estimate = tracked.estimate;
  if (estimate.map == nullptr) return std::nullopt;
  if (!start_) start_ = tracked.scan.time - std::chrono::seconds{1};  // so that 0 ms means "never"
  now_ms_ = static_cast<std::uint32_t>(
      std::chrono::duration_cast<std::chrono::milliseconds>(tracked.scan.time - *start_).count());
  take_map(estimate.map);
  short_beams_ = 0;
  through_beams_ = 0;
  if (!keyframes_.is_due(tracked) || !votes::speaks(estimate, tracked.turn_rate_rad_per_s, params_.beams))
    return std::nullopt;

  beams_ = votes::beam_evidence(*map_, clear_, tracked, params_.beams, std::move(beams_));
  count_beams();
  const std::vector<Cell> gone = small_objects_.missed(tracked, beams_, params_.beams);
  const votes::Votes& votes = votes_.of(beams_, gone, {clear_, layer_, redraw_queue_}, tracked.scan.bearing_step_rad);
  transients_.observe({votes.yes[0], votes.no[0], votes.yes[1], votes.no[1]}, tracked.scan.time, now_ms_);
  leaves_known_ground_ = !tells_of_known_ground(estimate.belief);
  const votes::Votes& told = without_unwritten_ground(leaves_known_ground_ ? without_known_ground(votes) : votes);
  cast(told);
  keyframes_.keep(tracked, told.all);
  redraw_queue_.see(told.ends);
  std::optional<ScanSet> set = waiting_.empty() ? std::nullopt : settled_regions(tracked.scan.time);
  return set ? std::move(set) : another_look(tracked.scan.time);
}

}  // namespace deltamap::mapping::evidence
