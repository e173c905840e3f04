// SPDX-License-Identifier: Apache-2.0
#include "daemon/dashboard/places.hpp"

#include <algorithm>
#include <map>
#include <tuple>

namespace deltamap::daemon::dashboard {

namespace {

enum class Turn : std::uint8_t { kStranger, kOneOfManyNew, kKnown, kNew };

}  // namespace

const Guest* first_to_leave(const std::vector<const Guest*>& guests) {
  const auto is_new = [](const Guest* guest) { return guest->standing == Standing::kHasCome; };
  const auto new_ones = static_cast<std::size_t>(std::count_if(guests.begin(), guests.end(), is_new));
  const Turn turn_of_new = 2 * new_ones > guests.size() ? Turn::kOneOfManyNew : Turn::kNew;
  const auto rank = [&](const Guest* guest) {
    const Turn turn = is_new(guest) ? turn_of_new : guest->is_known ? Turn::kKnown : Turn::kStranger;
    return std::tuple{turn, guest->standing, guest->since};
  };
  const Guest* first = nullptr;
  for (const Guest* const guest : guests) {
    if (guest->standing == Standing::kStays) continue;
    if (first == nullptr || rank(guest) < rank(first)) first = guest;
  }
  return first;
}

Welcome welcome_for(const std::string& from, const std::vector<const Guest*>& guests, const Places& places) {
  std::map<std::string, std::vector<const Guest*>> by_address;
  for (const Guest* const guest : guests) by_address[guest->from].push_back(guest);
  if (const auto own = by_address.find(from); own != by_address.end() && own->second.size() >= places.most_from_one) {
    const Guest* const leaves = first_to_leave(own->second);
    return {leaves != nullptr, leaves};
  }
  if (guests.size() < places.most) return {};
  std::size_t most = 0;
  for (const auto& [address, own] : by_address) most = std::max(most, own.size());
  std::vector<const Guest*> crowd;
  for (const Guest* const guest : guests) {
    if (by_address[guest->from].size() == most) crowd.push_back(guest);
  }
  const Guest* leaves = first_to_leave(crowd);
  if (leaves == nullptr) leaves = first_to_leave(guests);
  return {leaves != nullptr, leaves};
}

}  // namespace deltamap::daemon::dashboard
