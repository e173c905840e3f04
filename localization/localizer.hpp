// SPDX-License-Identifier: Apache-2.0
// Front door of localization: Odometry, Scan and MapRevision in, an Estimate for each scan out. Single-threaded, takes
// no lock, writes no log; the same messages and seed give the same estimates, bit for bit.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "core/messages.hpp"
#include "core/transient_obstacles.hpp"
#include "localization/belief/stability_record.hpp"
#include "localization/localizer_counts.hpp"
#include "localization/motion/drive_calibration.hpp"
#include "localization/particles/initial_pose.hpp"
#include "localization/sensor/range_scale.hpp"

namespace deltamap::localization {

struct LocalizerParams;
namespace particles {
struct ParticleSet;
}

class Localizer {
 public:
  /// Without an initial pose the whole map is searched (global localization).
  /// Throws std::runtime_error where the map has no free cell.
  Localizer(const LocalizerParams& params, std::shared_ptr<const OccupancyGrid> map,
            std::optional<particles::InitialPose> initial_pose, std::uint64_t seed);
  ~Localizer();
  Localizer(Localizer&&) noexcept;
  Localizer& operator=(Localizer&&) noexcept;

  void observe(const Odometry& odometry);

  /// One answer for every scan, whether the robot moved or not, lost or not.
  [[nodiscard]] TrackedScan observe(Scan scan);

  /// Where the wheels say that the robot was, in one frame over all epochs (TrackedScan::odom_from_robot); nothing
  /// before the first report.
  [[nodiscard]] std::optional<Pose2> odom_from_robot(Timestamp time) const;

  /// Takes M_k from the next scan on: copies the prepared patch where k follows the present number, else rebuilds.
  void apply(const MapRevision& revision);
  /// What is different from M_k for now, from the next scan on; null: nothing is known. Never localized on.
  void apply(std::shared_ptr<const TransientObstacles> transients);

  /// Starts again around a pose: one that a person gave is believed, a remembered one checked
  /// (particles/start_pose.hpp). False where nobody can stand there: all stays as it was.
  bool relocalize(const particles::InitialPose& pose);

  [[nodiscard]] const LocalizerCounts& counts() const;
  /// What the pose rests on, valid until the next message; null where it does not rest on particles: while straight
  /// surfaces lead, and while the whole map is searched.
  [[nodiscard]] const particles::ParticleSet* particles() const;
  /// Share of the newest scan's ends that the map explains at the estimated pose, [0, 1]; nothing where no beam came
  /// back, or none ended where a robot that drives by a given pose has a map.
  [[nodiscard]] std::optional<double> fit() const;
  /// What speaks for the pose: share of all beams that came back which the map explains, [0, 1]. Ends where the map
  /// knows nothing are no support. Nothing without a return.
  [[nodiscard]] std::optional<double> fit_of_all() const;

  /// The map explains the scans of some way clearly better with ranges of another scale; nothing else.
  [[nodiscard]] std::optional<sensor::OtherScale> range_scale() const;

  /// Errors of wheels and mount, as far as driving among surfaces has told; nothing where surfaces are not followed.
  [[nodiscard]] std::optional<motion::DriveCalibration> calibration() const;

  /// What of the map has proven to stay, to be kept across restarts.
  [[nodiscard]] belief::StabilityRecord stability() const;
  /// Takes what an earlier run has learned; false, and nothing taken, where it belongs to a map of another geometry.
  [[nodiscard]] bool restore(const belief::StabilityRecord& record);
  /// Before the first scan: what an earlier run has learned of wheels and mount.
  void restore(const motion::DriveCalibration& learned);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The bytes of the likelihood field around changed cells, computed aside (map thread) so that apply() only copies.
[[nodiscard]] FieldPatch prepared_field_patch(const LocalizerParams& params, const OccupancyGrid& map,
                                              std::span<const CellChange> changes);

}  // namespace deltamap::localization
