// SPDX-License-Identifier: Apache-2.0
// Why one vote for a block and keyframe: the beams of one scan share the error of its pose, so thirty of them on one
// block are not thirty witnesses.
#include "mapping/votes/beam_votes.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/grid/grid_ray.hpp"
#include "mapping/votes/face_step.hpp"

namespace deltamap::mapping::votes {

/// The surface that the beam met may lie in the block beside.
void BeamVotes::mark_still_there(Cell end, const ClearSpace& clear) {
  if (clear.blocks().contains(end)) {
    if (clear.distance(end) > 1 || (marks_[end] & kLookedAround) != 0) return;
    mark(end, kLookedAround);
  }
  clear.for_each_solid_around(end, [&](Cell block) { mark(block, kStillThere); });
}

void BeamVotes::mark_beam(const BeamVerdict& beam, const VotedMap& map) {
  const GridGeometry& blocks = map.layer.blocks();
  for (const Cell& cell : beam.passed) mark(map.layer.block_of(cell), kGone);
  const Cell end = blocks.cell_at(beam.end);
  const bool on_map = blocks.contains(end);
  if (on_map && beam.ends_off_map) mark(end, kNewHere);
  if (on_map && beam.ends_at_surface && map.watched.is_watched(end)) mark(end, kWatchedEnd);
  if (beam.ends_at_surface && !beam.ends_off_map) mark_still_there(end, map.clear);
  const double clear_m = beam.length_m - beam.interval_m - blocks.resolution_m / map.layer.lattice().cells_per_block();
  if (clear_m <= 0.0) return;
  const Point2 clear_end = beam.from + (beam.end - beam.from) * (clear_m / beam.length_m);
  map.layer.walk_open(beam.from, clear_end, [&](Cell block) { mark(block, kNothingNew); });
}

/// Far away, neighbouring beams end blocks apart: what lies between them on one new face is as new.
void BeamVotes::mark_faces(std::span<const BeamVerdict> beams, const GridGeometry& blocks, double bearing_step_rad) {
  const auto length_m = [&](std::size_t i) { return beams[i].ends_off_map ? beams[i].length_m : 0.0; };
  const auto end = [&](std::size_t i) -> const Point2& { return beams[i].end; };
  for_each_face_step(beams.size(), bearing_step_rad, length_m, end, [&](std::size_t i) {
    walk_ray(blocks, end(i), end(i + 1), [&](Cell block, double) {
      if (blocks.contains(block)) mark(block, kNewHere);
      return true;
    });
  });
}

/// Far away, neighbouring beams pass a face blocks apart: what lies between them on the face is as gone.
void BeamVotes::mark_gone_faces(std::span<const BeamVerdict> beams, const VotedMap& map, double bearing_step_rad) {
  const GridGeometry& blocks = map.layer.blocks();
  const auto squared_blocks = [](Cell a, Cell b) {
    const int columns = a.column - b.column;
    const int rows = a.row - b.row;
    return columns * columns + rows * rows;
  };
  for (std::size_t i = 0; i + 1 < beams.size(); ++i) {
    if (beams[i].length_m <= 0.0 || beams[i + 1].length_m <= 0.0 || beams[i].passed.empty()) continue;
    for (const Cell& beside : beams[i + 1].passed) {
      const Cell to = map.layer.block_of(beside);
      const auto nearest = std::min_element(beams[i].passed.begin(), beams[i].passed.end(), [&](Cell a, Cell b) {
        return squared_blocks(map.layer.block_of(a), to) < squared_blocks(map.layer.block_of(b), to);
      });
      const Cell from = map.layer.block_of(*nearest);
      const double step_m = kFaceSlant * (blocks.centre_of(to) - beams[i + 1].from).norm() * bearing_step_rad;
      const double apart_m = blocks.resolution_m * std::sqrt(squared_blocks(from, to));
      if (apart_m <= step_m + blocks.resolution_m) mark_gone_between(from, to, map.clear);
    }
  }
}

/// In whole blocks: where the way crosses a corner of blocks, rounding must not decide which of them it goes through.
void BeamVotes::mark_gone_between(Cell from, Cell to, const ClearSpace& clear) {
  const GridGeometry blocks{clear.blocks().width, clear.blocks().height, 1.0, {0.0, 0.0}};
  walk_ray(blocks, blocks.centre_of(from), blocks.centre_of(to), [&](Cell block, double) {
    if (clear.is_solid(block)) mark(block, kGone);
    return true;
  });
}

/// A block that was both hit and passed was hit.
void BeamVotes::collect() {
  constexpr auto kAdded = static_cast<std::size_t>(Question::kAdded);
  constexpr auto kRemoved = static_cast<std::size_t>(Question::kRemoved);
  for (Blocks* blocks : {&votes_.yes[0], &votes_.yes[1], &votes_.no[0], &votes_.no[1], &votes_.ends, &votes_.all}) {
    blocks->clear();
  }
  for (const auto& [marks_of_block, block] : marked_) {
    const Marks marks = std::exchange(*marks_of_block, Marks{0});
    if ((marks & kNewHere) != 0) {
      votes_.yes[kAdded].push_back(block);
    } else if ((marks & kNothingNew) != 0) {
      votes_.no[kAdded].push_back(block);
    }
    if ((marks & kStillThere) != 0) {
      votes_.no[kRemoved].push_back(block);
    } else if ((marks & kGone) != 0) {
      votes_.yes[kRemoved].push_back(block);
    }
    if ((marks & kWatchedEnd) != 0) votes_.ends.push_back(block);
    if (marks != kLookedAround) votes_.all.push_back(block);
  }
  marked_.clear();
  for (Blocks& yes : votes_.yes) std::sort(yes.begin(), yes.end());
}

const Votes& BeamVotes::of(std::span<const BeamVerdict> beams, std::span<const Cell> gone, const VotedMap& map,
                           double bearing_step_rad) {
  const GridGeometry& blocks = map.layer.blocks();
  if (!(blocks == blocks_)) {
    blocks_ = blocks;
    marks_ = Tiled<Marks>{blocks.width, blocks.height, 0};
  }
  for (const BeamVerdict& beam : beams) {
    if (beam.length_m > 0.0) mark_beam(beam, map);  // else silent
  }
  for (const Cell& cell : gone) mark(map.layer.block_of(cell), kGone);
  mark_faces(beams, blocks, bearing_step_rad);
  mark_gone_faces(beams, map, bearing_step_rad);
  collect();
  return votes_;
}

}  // namespace deltamap::mapping::votes
