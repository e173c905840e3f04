// SPDX-License-Identifier: Apache-2.0
// Why a merge was not made.
#pragma once

#include <cstdint>
#include <string_view>

namespace deltamap::mapping::merge {

enum class MergeRefusal : std::uint8_t {
  kNone,
  kTooFewPoints,  ///< not enough surface to place
  kLowAgreement,  ///< no pose in the search brings the surfaces together
  kImplausible,   ///< the best pose contradicts the prior (χ²)
  kAmbiguous      ///< two poses fit nearly equally
};
[[nodiscard]] std::string_view name_of(MergeRefusal refusal);

}  // namespace deltamap::mapping::merge
