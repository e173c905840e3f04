// SPDX-License-Identifier: Apache-2.0
#include "mapping/bays/bay_verdict.hpp"

#include <algorithm>
#include <cmath>

namespace deltamap::mapping::bays {
namespace {

constexpr double kSeenOfEmpty = 0.75;  // of the floor: what could hide in the rest is no load
constexpr double kSeenOfTaken = 0.7;
constexpr double kFull = 0.8;           // of all its floor is taken: it is full,
constexpr double kFullAfterAll = 0.95;  // where the shadow of a load may be all: what was partly full, unless another
constexpr int kRisen = 3;               // load stands (cells), and what was full, if another stands there now;
constexpr double kStaysFull = 0.7;      // and stays so
constexpr double kFreeOfFull = 0.1;     // of all its floor is seen free: from there on it is partly full
constexpr double kStaysFullFree = 0.15;
constexpr double kPartly = 0.1;  // share from which on it is not empty,
constexpr double kStaysPartly = 0.06;
constexpr double kAgainstFull = 0.4;   // free floor that no full bay has
constexpr double kAgainstEmpty = 0.2;  // taken floor that no empty bay has, though its neighbours' loads throw shadows
constexpr double kShadowCounts = 0.8;  // as seen

double share_of(int cells, const FloorCounts& counts) {
  return counts.cells > 0 ? static_cast<double>(cells) / counts.cells : 0.0;
}

}  // namespace

double taken_share(const FloorCounts& counts) {
  return counts.known() > 0 ? static_cast<double>(counts.taken + counts.shadowed) / counts.known() : 0.0;
}

double confidence_in(const FloorCounts& counts) {
  return share_of(counts.free + counts.taken, counts) + kShadowCounts * share_of(counts.shadowed, counts);
}

int least_known(const FloorCounts& counts, BayState state) {
  const double share = state == BayState::kEmpty ? kSeenOfEmpty : kSeenOfTaken;
  return std::max(1, static_cast<int>(std::ceil(share * counts.cells)));
}

std::optional<BayState> shown_state(const FloorCounts& counts, BayState so_far) {
  const double least_share = so_far == BayState::kPartly ? kStaysPartly : counts.taken == 0 ? kAgainstEmpty : kPartly;
  const bool is_taken = counts.body && taken_share(counts) >= least_share;
  if (!is_taken && counts.small > 0) return std::nullopt;  // somebody, or a load that is seen from its narrow side
  if (!is_taken && counts.free >= least_known(counts, BayState::kEmpty)) return BayState::kEmpty;
  if (!is_taken || counts.known() < least_known(counts, BayState::kPartly)) return std::nullopt;
  const double taken = share_of(counts.taken + counts.shadowed, counts);
  const bool has_another = counts.risen >= kRisen;
  const bool is_full = so_far == BayState::kFull && !has_another;
  if (share_of(counts.free_since, counts) >= (is_full ? kStaysFullFree : kFreeOfFull)) return BayState::kPartly;
  const bool is_doubtful = so_far == BayState::kPartly ? !has_another : so_far == BayState::kFull;
  const double least = is_full ? kStaysFull : is_doubtful ? kFullAfterAll : kFull;
  return taken >= least ? std::optional{BayState::kFull} : std::nullopt;
}

bool contradicts(const FloorCounts& counts, BayState state) {
  if (state == BayState::kFull) return share_of(counts.free, counts) >= kAgainstFull;
  if (state == BayState::kEmpty)
    return counts.body && share_of(counts.taken + counts.shadowed, counts) >= kAgainstEmpty;
  return false;
}

}  // namespace deltamap::mapping::bays
