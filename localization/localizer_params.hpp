// SPDX-License-Identifier: Apache-2.0
// Everything that can be set about localization. Each part's own parameters stand beside the part.
#pragma once

#include "core/angle.hpp"
#include "localization/beam_model.hpp"
#include "localization/fit_monitor.hpp"
#include "localization/global_search.hpp"
#include "localization/hypotheses.hpp"
#include "localization/judgement.hpp"
#include "localization/likelihood_field.hpp"
#include "localization/motion_model.hpp"
#include "localization/odometry_buffer.hpp"
#include "localization/particle_filter.hpp"
#include "localization/place_bank.hpp"
#include "localization/pose_refinement.hpp"
#include "localization/pose_track.hpp"
#include "localization/rivals.hpp"

namespace deltamap::localization {

/// When a scan changes the particles' weights. In between the estimate follows odometry and refinement alone, so that a
/// robot that stands still does not talk itself into certainty.
struct UpdateParams {
  double distance_m = 0.05;        ///< driven since the last update, m; >= 0
  double turn_rad = radians(2.0);  ///< turned since the last update, rad; >= 0
  double time_s = 1.0;             ///< passed since the last update, s; > 0
};

struct LocalizerParams {
  double gap_s = 20.0;  ///< without a scan, after which the pose must prove itself again, s; > 0
  int beams = 0;        ///< beams of a scan that score, evenly chosen among the valid ones; 0 = all
  ParticleFilterParams particles;
  OdometryBufferParams odometry;
  MotionModelParams motion;
  ScanModel model = ScanModel::kLikelihoodField;  ///< what weighs the particles
  LikelihoodFieldParams field;
  BeamModelParams beam_model;  ///< with kBeam
  HypothesisParams hypothesis;
  RefinementParams refinement;
  PoseTrackParams track;
  UpdateParams update;
  GlobalSearchParams global;
  RivalsParams rivals;
  PlaceBankParams places;
  FitParams fit;
  JudgementParams judgement;
};

}  // namespace deltamap::localization
