// SPDX-License-Identifier: Apache-2.0
#include "mapping/merge/merge_refusal.hpp"

namespace deltamap::mapping::merge {

std::string_view name_of(MergeRefusal refusal) {
  switch (refusal) {
    case MergeRefusal::kNone:
      return "none";
    case MergeRefusal::kTooFewPoints:
      return "too few points";
    case MergeRefusal::kLowAgreement:
      return "low agreement";
    case MergeRefusal::kImplausible:
      return "implausible";
    case MergeRefusal::kAmbiguous:
      return "ambiguous";
  }
  return "?";
}

}  // namespace deltamap::mapping::merge
