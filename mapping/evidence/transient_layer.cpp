// SPDX-License-Identifier: Apache-2.0
#include "mapping/evidence/transient_layer.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/grid/near_occupied.hpp"

namespace deltamap::mapping::evidence {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// Do the shown entries name the same blocks?
template <typename Entries>
bool shows(const Entries& entries, const std::vector<std::uint32_t>& blocks) {
  auto block = blocks.begin();
  for (const auto& entry : entries) {
    if (!entry.is_shown) continue;
    if (block == blocks.end() || *block != entry.block) return false;
    ++block;
  }
  return block == blocks.end();
}

template <typename Entries>
std::vector<std::uint32_t> shown(const Entries& entries) {
  std::vector<std::uint32_t> blocks;
  for (const auto& entry : entries) {
    if (entry.is_shown) blocks.push_back(entry.block);
  }
  return blocks;
}

}  // namespace

TransientLayer::TransientLayer(const TransientLayerParams& params, const BlockLattice& lattice)
    : params_{params}, lattice_{lattice} {}

void TransientLayer::observe(const Votes& votes, Timestamp time, std::uint32_t now_ms) {
  vote_no(standing_, votes.not_added, now_ms);
  vote_yes(standing_, votes.added, now_ms);
  vote_no(gone_, votes.not_removed, now_ms);
  vote_yes(gone_, votes.removed, now_ms);
  publish(time);
}

/// What has no votes left goes with the pass over all entries that follows.
void TransientLayer::vote_no(Entries& entries, std::span<const std::uint32_t> blocks, std::uint32_t now_ms) {
  if (entries.empty()) return;
  for (const std::uint32_t block : blocks) {
    const auto entry = std::lower_bound(entries.begin(), entries.end(), block,
                                        [](const Entry& e, std::uint32_t index) { return e.block < index; });
    if (entry == entries.end() || entry->block != block || entry->votes == 0) continue;
    --entry->votes;
    entry->last_ms = now_ms;
  }
}

/// Entries and votes are both in order: one pass over them, into the memory of the pass before.
void TransientLayer::vote_yes(Entries& entries, std::span<const std::uint32_t> blocks, std::uint32_t now_ms) {
  spare_.clear();
  auto known = entries.begin();
  auto yes = blocks.begin();
  while (known != entries.end() || yes != blocks.end()) {
    const std::uint32_t next_known = known == entries.end() ? kNone : known->block;
    const std::uint32_t next_yes = yes == blocks.end() ? kNone : *yes;
    Entry entry = next_known <= next_yes ? *known++ : Entry{next_yes, now_ms, 0, false};
    if (entry.block == next_yes) {
      ++yes;
      entry.votes = static_cast<std::uint8_t>(std::min<std::uint32_t>(params_.most_votes, entry.votes + 1U));
      entry.last_ms = now_ms;
      entry.is_shown = entry.is_shown || entry.votes >= params_.least_votes;
    }
    const bool has_lapsed = 1e-3 * (now_ms - entry.last_ms) > params_.lapse_s;
    if (entry.votes > 0 && !has_lapsed) spare_.push_back(entry);
  }
  std::swap(entries, spare_);
  if (entries.size() > params_.most_blocks) keep_newest(entries, now_ms);
}

void TransientLayer::keep_newest(Entries& entries, std::uint32_t now_ms) {
  ages_.clear();
  for (const Entry& entry : entries) ages_.push_back(now_ms - entry.last_ms);
  const auto limit = ages_.begin() + static_cast<std::ptrdiff_t>(params_.most_blocks);
  std::nth_element(ages_.begin(), limit, ages_.end());
  // As many may be as old as the one at the limit: those of them stay that there is room for.
  const auto younger = static_cast<std::size_t>(
      std::count_if(entries.begin(), entries.end(), [&](const Entry& e) { return now_ms - e.last_ms < *limit; }));
  std::size_t room = params_.most_blocks - younger;
  std::erase_if(entries, [&](const Entry& entry) {
    const std::uint32_t age = now_ms - entry.last_ms;
    if (age != *limit || room == 0) return age >= *limit;
    --room;
    return false;
  });
}

void TransientLayer::follow(const OccupancyGrid& map) {
  const auto has_surface = [&](const Entry& entry, int margin_cells) {
    return has_occupied(map, grown(lattice_.cells_of(lattice_.blocks().cell_of(entry.block)), margin_cells));
  };
  std::erase_if(standing_, [&](const Entry& entry) { return has_surface(entry, 1); });
  std::erase_if(gone_, [&](const Entry& entry) { return !has_surface(entry, 0); });
}

void TransientLayer::hide(Timestamp time) {
  if (newest_ == nullptr || newest_->empty()) return;
  newest_ = std::make_shared<const TransientObstacles>(TransientObstacles{
      .number = newest_->number + 1, .time = time, .blocks = lattice_.blocks(), .standing = {}, .gone = {}});
}

void TransientLayer::clear() {
  standing_.clear();
  gone_.clear();
}

void TransientLayer::publish(Timestamp time) {
  const bool tells_the_same = newest_ == nullptr ? shows(standing_, {}) && shows(gone_, {})
                                                 : shows(standing_, newest_->standing) && shows(gone_, newest_->gone);
  if (tells_the_same) return;
  newest_ = std::make_shared<const TransientObstacles>(
      TransientObstacles{.number = newest_ == nullptr ? 1 : newest_->number + 1,
                         .time = time,
                         .blocks = lattice_.blocks(),
                         .standing = shown(standing_),
                         .gone = shown(gone_)});
}

}  // namespace deltamap::mapping::evidence
