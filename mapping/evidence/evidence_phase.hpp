// SPDX-License-Identifier: Apache-2.0
// Store-scan by evidence: keyframes vote block by block on what is new and what is gone; what keeps being voted for
// long enough, from enough keyframes and over a large enough region becomes an S(k) with its verdicts.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/grid/tiled.hpp"
#include "core/messages.hpp"
#include "core/zones.hpp"
#include "mapping/evidence/evidence_regions.hpp"
#include "mapping/evidence/passing.hpp"
#include "mapping/evidence/small_objects.hpp"
#include "mapping/evidence/transient_layer.hpp"
#include "mapping/scan_set/keyframe_pool.hpp"
#include "mapping/votes/beam_evidence.hpp"
#include "mapping/votes/beam_votes.hpp"
#include "mapping/votes/changed_this_run.hpp"
#include "mapping/votes/clear_space.hpp"
#include "mapping/votes/redraw_queue.hpp"
#include "mapping/votes/vote_layer.hpp"

namespace deltamap::mapping::evidence {

struct EvidencePhaseParams {
  double face_persistence_s = 1.5;  ///< votes on what does not only pass must span at least so long; >= 0
  double least_votes = 3.0;         ///< keyframes that say so, worn votes not counted; > 0
  double least_share = 0.8;         ///< of the votes on a block that say so; (0.5, 1]
  int reach_blocks = 2;             ///< proven blocks at most so far apart are one region; >= 1
  std::uint32_t least_blocks = 3;   ///< a smaller region is too small and waits; >= 1
  double draws_at_once_s = 0.2;     ///< new ground, which the pose may come to rest on, is drawn after so long; else
  double settle_s = 2.0;            ///< a region is handed on when it has not grown for so long, …
  double most_wait_s = 6.0;         ///< … or has waited so long
  std::uint32_t least_look_cells = 12;  ///< another look that changes fewer writes nothing, unless it is the last; >= 1
  double joining_votes = 2.0;       ///< blocks beside an added region with so many votes and the share are taken along
  double joining_gone_votes = 1.0;  ///< the same beside a removed one
  double changed_this_run_persistence_s = 0.3;  ///< votes that what this run itself has written is gone must span; >= 0
  votes::BeamEvidenceParams beams;
  votes::VoteLayerParams votes;
  scan_set::KeyframeParams keyframes;
  votes::RedrawQueueParams redraw_queue;
  PassingParams passing;
  SmallObjectParams small_objects;
  TransientLayerParams temporary;
};

class EvidencePhase {
 public:
  explicit EvidencePhase(const EvidencePhaseParams& params);

  [[nodiscard]] std::optional<ScanSet> observe(const TrackedScan& tracked);

  /// Nothing there is proven, whatever is voted for: it stays transient. From the next scan on.
  void leave_unwritten(ZonedGround ground) { unwritten_ = std::move(ground); }

  [[nodiscard]] std::uint32_t number() const { return phase_; }
  /// Blocks that are proven and wait to be handed on.
  [[nodiscard]] std::size_t waiting() const { return waiting_.size(); }
  /// The keyframes that a set of these blocks would be drawn from now, in order of time.
  [[nodiscard]] KeptScans scans_of_waiting() const;
  [[nodiscard]] std::uint32_t short_beams() const { return short_beams_; }
  [[nodiscard]] std::uint32_t through_beams() const { return through_beams_; }
  /// What every keyframe has told so far, long before it is proven.
  [[nodiscard]] TransientLayer& transients() { return transients_; }

 private:
  /// What was handed on of a region: its blocks, sorted, and when the first vote for them was cast.
  struct Handed {
    votes::Blocks blocks;
    std::uint32_t first_ms = 0;
  };

  void take_map(std::shared_ptr<const OccupancyGrid> map);
  void count_beams();
  [[nodiscard]] bool is_large_enough(const std::vector<ProvenBlock>& region) const;
  /// Until the next call.
  [[nodiscard]] const votes::Votes& without_known_ground(const votes::Votes& votes);
  /// Until the next call.
  [[nodiscard]] const votes::Votes& without_unwritten_ground(const votes::Votes& votes);
  [[nodiscard]] bool is_unwritten(Cell cell) const;
  /// At the begin of the run.
  [[nodiscard]] bool was_known(Cell cell) const;
  void cast(const votes::Votes& votes);
  [[nodiscard]] bool is_proven(votes::Question question, Cell block) const;
  [[nodiscard]] std::optional<ScanSet> settled_regions(Timestamp time);
  [[nodiscard]] bool is_new_ground(const std::vector<ProvenBlock>& region) const;
  [[nodiscard]] bool is_settled(const std::vector<ProvenBlock>& region) const;
  [[nodiscard]] bool is_changed_this_run(const std::vector<ProvenBlock>& region) const;
  Handed hand_on(const std::vector<ProvenBlock>& region, std::vector<CellVerdict>& verdicts);
  void add_remains(std::vector<CellVerdict>& gone, votes::Blocks& blocks) const;
  void keep_in_view(const std::vector<ProvenBlock>& region, const Handed& handed);
  [[nodiscard]] std::vector<Cell> with_joining_blocks(const std::vector<ProvenBlock>& region);
  void add_verdicts(votes::Question question, Cell block, std::vector<CellVerdict>& verdicts) const;
  void begin_anew(votes::Question question, Cell block);
  [[nodiscard]] std::optional<ScanSet> another_look(Timestamp time);
  [[nodiscard]] std::optional<ScanSet> with_scans(ScanSet set, const votes::Blocks& blocks, std::uint32_t first_ms);

  EvidencePhaseParams params_;
  std::shared_ptr<const OccupancyGrid> map_;
  std::shared_ptr<const OccupancyGrid> begun_with_;
  votes::Votes votes_on_new_ground_;
  votes::Votes votes_on_written_ground_;
  ZonedGround unwritten_;
  bool leaves_known_ground_ = false;  // as it is: by the newest keyframe
  votes::VoteLayer layer_;
  TransientLayer transients_;
  scan_set::KeyframePool keyframes_;
  std::vector<votes::BeamVerdict> beams_;
  std::vector<ProvenBlock> waiting_;
  votes::ClearSpace clear_;
  votes::BeamVotes votes_;
  Tiled<std::uint8_t> joined_;  // a flag a block: belongs to the region that is being handed on
  votes::RedrawQueue redraw_queue_;
  Passing passing_;
  SmallObjects small_objects_;
  votes::ChangedThisRun changed_this_run_;
  std::optional<Timestamp> start_;
  std::uint32_t now_ms_ = 0;
  std::uint32_t phase_ = 0;
  std::uint32_t short_beams_ = 0;
  std::uint32_t through_beams_ = 0;
};

}  // namespace deltamap::mapping::evidence
