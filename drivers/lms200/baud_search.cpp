// SPDX-License-Identifier: Apache-2.0
#include "drivers/lms200/baud_search.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>

namespace deltamap::drivers::lms200 {
namespace {

constexpr std::array<unsigned, 4> kSearchOrder{38400, 9600, 500000, 19200};  // B8
constexpr unsigned kPowerOnBaud = 9600;

}  // namespace

std::vector<unsigned> baud_search(unsigned first) {
  std::vector<unsigned> bauds{first};
  std::copy_if(kSearchOrder.begin(), kSearchOrder.end(), std::back_inserter(bauds),
               [first](unsigned baud) { return baud != first; });
  return bauds;
}

VisitPlan::VisitPlan(unsigned home, bool was_garbage)
    : bauds_{baud_search(home)}, is_detour_{was_garbage && home != kPowerOnBaud} {}

unsigned VisitPlan::baud() const {
  if (is_detour_) return kPowerOnBaud;
  if (visits_ % 2 == 0) return home();
  constexpr unsigned kTurnsOfOthers = 3;  // one of so many is another than the baud after a power cut
  const bool may_have_lost_power = home() != kPowerOnBaud;
  const unsigned turn = visits_ / 2;
  if (may_have_lost_power && turn % kTurnsOfOthers != kTurnsOfOthers - 1) return kPowerOnBaud;
  const std::size_t other = may_have_lost_power ? turn / kTurnsOfOthers : turn;
  return bauds_[1 + other % (bauds_.size() - 1)];
}

void VisitPlan::advance(bool was_garbage, bool is_long_silent) {
  const unsigned visited = baud();
  is_detour_ = was_garbage && !is_detour_ && visited != kPowerOnBaud && home() != kPowerOnBaud;
  if (!is_detour_ && (is_long_silent || was_garbage || visited != home())) ++visits_;
}

std::string VisitPlan::names() const {
  std::string names;
  for (const unsigned baud : bauds_) names += (names.empty() ? "" : ", ") + std::to_string(baud);
  return names;
}

}  // namespace deltamap::drivers::lms200
