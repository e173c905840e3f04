// SPDX-License-Identifier: Apache-2.0
// Everything that can be set about localization. Each part's own parameters stand beside the part.
#pragma once

#include "core/geometry/angle.hpp"
#include "core/messages.hpp"
#include "localization/belief/fit_monitor.hpp"
#include "localization/belief/judgement.hpp"
#include "localization/hypotheses/global_search.hpp"
#include "localization/hypotheses/hypothesis_tracker.hpp"
#include "localization/motion/odometry_buffer.hpp"
#include "localization/sensor/likelihood_field.hpp"
#include "localization/sensor/transient_beams.hpp"
#include "localization/tracking/tracker.hpp"

namespace deltamap::localization {

struct LocalizerParams : tracking::TrackerParams {
  double gap_s = 20.0;  ///< without scan and odometry, after which the pose must prove itself again, s; > 0
  int beams = 0;        ///< beams of a scan that score, evenly chosen among the valid ones; 0 = all
  double range_deviation_m = kRangeDeviationM;  ///< 1 σ of a range, for all who read the tracked scan, m; > 0
  motion::OdometryBufferParams odometry;
  sensor::LikelihoodFieldParams field;
  hypotheses::GlobalSearchParams global;
  hypotheses::HypothesisTrackerParams hypothesis_tracker;
  belief::FitParams fit;
  belief::JudgementParams judgement;
  sensor::TransientBeamsParams temporary;
};

}  // namespace deltamap::localization
