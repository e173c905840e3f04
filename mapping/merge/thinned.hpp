// SPDX-License-Identifier: Apache-2.0
// Every n-th of a list, for looks that need not see all.
#pragma once

#include <cstddef>
#include <vector>

namespace deltamap::mapping::merge {

template <typename Item>
[[nodiscard]] std::vector<Item> every(const std::vector<Item>& all, std::size_t stride) {
  std::vector<Item> left;
  left.reserve(all.size() / stride + 1);
  for (std::size_t i = 0; i < all.size(); i += stride) left.push_back(all[i]);
  return left;
}

/// At most about so many, evenly chosen.
template <typename Item>
[[nodiscard]] std::vector<Item> thinned_to(const std::vector<Item>& all, std::size_t most) {
  return every(all, all.size() / most + 1);
}

}  // namespace deltamap::mapping::merge
