// SPDX-License-Identifier: Apache-2.0
#include "daemon/dashboard/places.hpp"

#include <algorithm>
#include <map>
#include <tuple>

namespace deltamap::daemon::dashboard {

const Guest* first_to_leave(const std::vector<const Guest*>& guests) {
  const auto rank = [](const Guest* guest) { return std::tuple{guest->is_known, guest->standing, guest->since}; };
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
  const auto has_less = [](const auto& one, const auto& other) { return one.second.size() < other.second.size(); };
  const auto crowd = std::max_element(by_address.begin(), by_address.end(), has_less);
  const Guest* leaves = crowd == by_address.end() ? nullptr : first_to_leave(crowd->second);
  if (leaves == nullptr) leaves = first_to_leave(guests);
  return {leaves != nullptr, leaves};
}

}  // namespace deltamap::daemon::dashboard
