// SPDX-License-Identifier: Apache-2.0
// Watches the places where the map looks as it does here, so that the write gate hears of it at once if the robot has
// been carried to one: those that were met before, and those with the believed heading turned by right angles, for so
// most images of a place lie in a building. None is believed for being watched: places that are looked at again and
// again would sooner or later win by chance.
#pragma once

#include <cstddef>
#include <span>

#include "localization/hypotheses/lattice_search.hpp"
#include "localization/hypotheses/place_bank.hpp"
#include "localization/hypotheses/place_images.hpp"
#include "localization/hypotheses/scan_stack.hpp"
#include "localization/sensor/coarse_field.hpp"

namespace deltamap::localization::hypotheses {

class ImageWatch {
 public:
  struct Effort {
    int images = 16;           ///< that are remembered; >= 0
    int images_a_scan = 2;     ///< of them looked at again in a scan; >= 0
    int probes = 400;          ///< poses turned by right angles that are looked at in a scan; >= 0
    int slid = 4;              ///< places that are slid to their best fit in a scan, beside those that come close; >= 0
    double nearby_m = 1.5;     ///< no image of the believed pose but a slip, m; > 0
    double nearby_rad = 0.35;  ///< and turned less; > 0
    double prior = 0.003;      ///< odds of one against the believed pose, before any scan; 0..1
  };
  ImageWatch(const PlaceBankParams& bank, const Effort& effort);

  /// Forgets what speaks for them, not where they are.
  void clear() { bank_.clear(); }
  void carry(const Pose2& motion);

  struct Seen {
    const sensor::LikelihoodField& field;
    const sensor::CoarseField& coarse;
    const motion::BeamEnds& ends;
    const motion::BeamEnds& near_ends;  ///< that a coarse lattice can place
    Pose2 map_from_believed;            ///< slid to where the scan fits, as its images will be
    Pose2 joined_from_robot;
    const ScanStack& stack;
    double telling = 1.0;              ///< how much beams that miss say, [0, 1]
    std::span<const float> weights{};  ///< of the beams, where the scan tells something new
    double unknown_s = 0.0;
  };
  /// Every scan beside a believed pose, after carry(). `followed`: places that explain the scans as well.
  void observe(const Seen& seen, std::span<const Place> followed);

  /// The believed pose and its images.
  [[nodiscard]] const PlaceBank& places() const { return bank_; }

 private:
  void note(std::span<const Place> followed, const Pose2& map_from_believed);
  void look_again(const Seen& seen);
  void probe(const Seen& seen);
  void admit(const Pose2& rough, const Seen& seen);

  Effort effort_;
  PlaceBank bank_;
  PlaceImages images_;
  LatticeSearch lattice_;
  motion::BeamEnds turned_;  // to the believed heading
  double own_fit_ = 0.0;     // mean ln p(z) of the scan at the believed pose
};

}  // namespace deltamap::localization::hypotheses
