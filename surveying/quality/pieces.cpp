// SPDX-License-Identifier: Apache-2.0
#include "surveying/quality/pieces.hpp"

#include <algorithm>
#include <numeric>

namespace deltamap::surveying::quality {
namespace {

constexpr std::uint32_t kFewestEnded = 20;  // beams on each other's walls

}  // namespace

std::vector<Piece> pieces_of(std::span<const Pass> passes, std::span<const PassPair> pairs) {
  std::vector<std::uint32_t> piece_of(passes.size());
  std::iota(piece_of.begin(), piece_of.end(), 0U);
  const auto root = [&](std::uint32_t pass) {
    while (piece_of[pass] != pass) pass = piece_of[pass] = piece_of[piece_of[pass]];
    return pass;
  };
  for (const PassPair& pair : pairs) {
    if (pair.ended >= kFewestEnded && pair.through_share() <= kMostThrough) piece_of[root(pair.one)] = root(pair.other);
  }
  std::vector<Piece> by_root(passes.size());
  for (std::uint32_t i = 0; i < passes.size(); ++i) {
    Piece& piece = by_root[root(i)];
    piece.passes.push_back(i);
    piece.way_m += passes[i].ended_m - passes[i].began_m;
  }
  std::erase_if(by_root, [](const Piece& piece) { return piece.passes.empty(); });
  std::stable_sort(by_root.begin(), by_root.end(), [](const Piece& a, const Piece& b) { return a.way_m > b.way_m; });
  return by_root;
}

}  // namespace deltamap::surveying::quality
