// SPDX-License-Identifier: Apache-2.0
// Everything that can be set about localization. Each part's own parameters stand beside the part.
#pragma once

#include "core/angle.hpp"
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
#include "localization/temporary_beams.hpp"
#include "localization/tracker.hpp"

namespace deltamap::localization {

struct LocalizerParams {
  double gap_s = 20.0;  ///< without scan and odometry, after which the pose must prove itself again, s; > 0
  int beams = 0;        ///< beams of a scan that score, evenly chosen among the valid ones; 0 = all
  ParticleFilterParams particles;
  OdometryBufferParams odometry;
  MotionModelParams motion;
  LikelihoodFieldParams field;
  HypothesisParams hypothesis;
  RefinementParams refinement;
  PoseTrackParams track;
  UpdateParams update;
  bool follow_surfaces = true;  ///< as of TrackerParams
  GlobalSearchParams global;
  RivalsParams rivals;
  PlaceBankParams places;
  FitParams fit;
  JudgementParams judgement;
  TemporaryBeamsParams temporary;
};

}  // namespace deltamap::localization
