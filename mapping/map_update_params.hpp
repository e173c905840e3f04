// SPDX-License-Identifier: Apache-2.0
// The parameters of map_update(): one set a method.
#pragma once

#include "mapping/paper/paper_update.hpp"
#include "mapping/redraw/evidence_update.hpp"

namespace deltamap::mapping {

struct MapUpdateParams {
  redraw::EvidenceUpdateParams evidence;
  paper::PaperUpdateParams paper;
};

}  // namespace deltamap::mapping
