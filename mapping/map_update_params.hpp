// SPDX-License-Identifier: Apache-2.0
// The parameters of map_update(): one set a method.
#pragma once

#include "mapping/evidence_update.hpp"
#include "mapping/paper_update.hpp"

namespace deltamap::mapping {

struct MapUpdateParams {
  EvidenceUpdateParams evidence;
  PaperUpdateParams paper;
};

}  // namespace deltamap::mapping
