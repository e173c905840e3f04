// SPDX-License-Identifier: Apache-2.0
#include "mapping/scan_set/map_change.hpp"

namespace deltamap::mapping::scan_set {

std::string_view name_of(Refusal refusal) {
  switch (refusal) {
    case Refusal::kNone:
      return "none";
    case Refusal::kTooFewScans:
      return "too few scans";
    case Refusal::kNoAlignment:
      return "no alignment";
    case Refusal::kNoMerge:
      return "no merge";
    case Refusal::kLowAcceptance:
      return "low acceptance";
    case Refusal::kImplausible:
      return "implausible";
    case Refusal::kNothingChanged:
      return "nothing changed";
    case Refusal::kPoseInDoubt:
      return "pose in doubt";
    case Refusal::kSetByOperator:
      return "set by an operator";
    case Refusal::kZoned:
      return "in a zone that is never written";
  }
  return "?";
}

bool leaves_map_stale(Refusal refusal) {
  switch (refusal) {
    case Refusal::kNone:
    case Refusal::kNothingChanged:
    case Refusal::kSetByOperator:
    case Refusal::kZoned:
      return false;
    case Refusal::kTooFewScans:
    case Refusal::kNoAlignment:
    case Refusal::kNoMerge:
    case Refusal::kLowAcceptance:
    case Refusal::kImplausible:
    case Refusal::kPoseInDoubt:
      return true;
  }
  return true;
}

}  // namespace deltamap::mapping::scan_set
