// SPDX-License-Identifier: Apache-2.0
// `deltamap calibrate motion`: how far the wheels of a recording can be trusted, as keys to paste into the settings.
#include <CLI/CLI.hpp>
#include <iomanip>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

#include "core/counted.hpp"
#include "daemon/control/calibration_json.hpp"
#include "daemon/settings/settings.hpp"
#include "localization/localizer.hpp"
#include "surveying/calibration/motion_calibration.hpp"
#include "tool/recorded_messages.hpp"
#include "tool/subcommands.hpp"
#include "tool/told_grid.hpp"

namespace deltamap::tool {
namespace {

using Json = nlohmann::ordered_json;
using surveying::calibration::Fitted;
using surveying::calibration::MotionCalibration;
using surveying::calibration::MotionSource;
using surveying::calibration::Systematic;

constexpr std::size_t kFewestSegments = 20;  // a deviation from 20 segments is good to 16 % at best
constexpr double kLeastSureShare = 0.5;      // of the scans; a robot on a foreign map seldom has more
constexpr double kSurePositionM = 0.15;      // an estimate that claims less does not count
constexpr double kSureHeadingRad = radians(4.0);
constexpr double kVague = 0.3;  // relative standard error from which on a deviation is warned about

struct CalibrateOptions {
  std::string recording;
  std::string map;
  std::string config;
  std::vector<std::string> overrides;
  std::string initial_pose;
  bool as_json = false;
};

struct Drive {
  std::vector<surveying::calibration::MotionSegment> segments;
  double driven_m = 0.0;
  double turned_rad = 0.0;
  std::size_t scans = 0;
  std::size_t sure_scans = 0;
  std::optional<localization::motion::DriveCalibration> learned;  ///< by the localizer as it is set, while driving
  drivers::port::LogFaults faults;                                ///< of the recording
};

bool is_sure(const Estimate& estimate) {
  const Eigen::Vector3d variance = estimate.covariance.diagonal();
  return estimate.state == LocalizerState::kTracking &&
         variance.head<2>().maxCoeff() < kSurePositionM * kSurePositionM &&
         variance.z() < kSureHeadingRad * kSureHeadingRad;
}

/// Follows the recording on the map and cuts it into segments.
Drive driven(const CalibrateOptions& options, const daemon::Settings& settings) {
  std::optional<localization::particles::InitialPose> start;
  if (settings.initial_pose) start = localization::particles::InitialPose{*settings.initial_pose};
  const auto map = std::make_shared<const OccupancyGrid>(told_grid(options.map));
  localization::Localizer as_set{settings.localizer, map, start, settings.seed};
  localization::LocalizerParams params = settings.localizer;
  params.follow_surfaces = false;  // wheels as they count, not as they have been corrected
  localization::Localizer localizer{params, map, start, settings.seed};
  const auto& update = settings.localizer.update;
  surveying::calibration::MotionSegments pairs{
      {.step_m = std::max(1e-3, update.distance_m), .step_rad = std::max(1e-3, update.turn_rad)}};
  Drive drive;
  const daemon::RecordingDecoder::Sinks sinks{
      [&](Odometry&& odometry, std::uint32_t) {
        as_set.observe(odometry);
        localizer.observe(odometry);
      },
      [&](Scan&& scan) {
        (void)as_set.observe(scan);
        const TrackedScan tracked = localizer.observe(std::move(scan));
        const bool sure = is_sure(tracked.estimate);
        ++drive.scans;
        drive.sure_scans += sure ? 1 : 0;
        pairs.observe({tracked.odom_from_robot, tracked.odometry_epoch, tracked.estimate.map_from_robot, sure});
      }};
  drive.faults = read_messages(options.recording, settings, sinks, "calibrate");
  drive.learned = as_set.calibration();
  drive.segments = pairs.segments();
  for (const auto& segment : drive.segments) {
    drive.driven_m += segment.driven_m;
    drive.turned_rad += segment.turned_rad;
  }
  return drive;
}

/// A key of the settings, and the deviation that it holds.
struct FittedKey {
  const char* key;
  MotionSource source;
  double unit;  ///< of the key, in SI
  const char* supported_by;
};
constexpr FittedKey kKeys[] = {
    {"turn_per_turn", MotionSource::kTurnPerTurn, 1.0, "turning"},
    {"turn_per_metre_deg", MotionSource::kTurnPerMetre, radians(1.0), "driving"},
    {"metre_per_metre", MotionSource::kMetrePerMetre, 1.0, "driving"},
    {"metre_per_turn_m", MotionSource::kMetrePerTurn, 1.0, "turning"},
};

bool is_vague(const Fitted& fitted) { return !(fitted.error < kVague * fitted.value); }

void print_keys(const MotionCalibration& found) {
  std::cout << "localization:\n  motion:\n" << std::fixed << std::setprecision(4);
  for (const FittedKey& key : kKeys) {
    const Fitted& fitted = found.of(key.source);
    if (is_vague(fitted)) {
      std::cout << "    # " << key.key << ": keep the default, too little " << key.supported_by << " to tell (";
    } else {
      std::cout << "    " << key.key << ": " << fitted.value / key.unit << "  # from " << key.supported_by << " (";
    }
    std::cout << fitted.value / key.unit << " +- " << fitted.error / key.unit << ")\n";
  }
}

void print_calibration_text(const MotionCalibration& as_they_are, const MotionCalibration& corrected,
                            const Drive& drive) {
  std::cout << std::setprecision(3) << "# " << drive.driven_m << " m and " << degrees(drive.turned_rad) / 360.0
            << " turns in " << counted(drive.segments.size(), "segment") << ", " << 100.0 * as_they_are.outlier_share
            << " % of them rather slips; the localizer's own error "
            << as_they_are.of(MotionSource::kEstimatePosition).value << " m, "
            << degrees(as_they_are.of(MotionSource::kEstimateHeading).value) << " deg\n";
  print_keys(as_they_are);
  std::cout << "# systematic, covered by the deviations above:\n"
            << "# true metres a metre of odometry: " << 1.0 + corrected.wheel_scale.value << " +- "
            << corrected.wheel_scale.error << " (wheels)\n"
            << "# true turn a turn of odometry:    " << 1.0 + corrected.turn_scale.value << " +- "
            << corrected.turn_scale.error << " (track)\n"
            << "# true turn a metre driven:        " << degrees(corrected.drift_rad_per_m.value) << " +- "
            << degrees(corrected.drift_rad_per_m.error)
            << " deg (unequal wheels)\n# with it corrected, the deviations would be";
  for (const FittedKey& key : kKeys) std::cout << ' ' << corrected.of(key.source).value / key.unit;
  std::cout << "\n# found and corrected while driving, as `calibration` in `deltamap ctl status`:\n# "
            << daemon::control::calibration_json(drive.learned) << '\n';
}

Json json_of_fitted(const Fitted& fitted, double unit = 1.0) {
  return {{"value", fitted.value / unit}, {"error", fitted.error / unit}};
}

void print_calibration_json(const MotionCalibration& as_they_are, const MotionCalibration& corrected,
                            const Drive& drive) {
  Json motion;
  Json motion_corrected;
  for (const FittedKey& key : kKeys) {
    motion[key.key] = json_of_fitted(as_they_are.of(key.source), key.unit);
    motion[key.key]["enough"] = !is_vague(as_they_are.of(key.source));
    motion_corrected[key.key] = json_of_fitted(corrected.of(key.source), key.unit);
  }
  const Json all{{"cut", drive.faults.cut ? Json(drive.faults.cut->text) : Json(nullptr)},
                 {"doubts", drive.faults.doubts},
                 {"segments", drive.segments.size()},
                 {"driven_m", drive.driven_m},
                 {"turned_deg", degrees(drive.turned_rad)},
                 {"outlier_share", as_they_are.outlier_share},
                 {"estimate_position_m", as_they_are.of(MotionSource::kEstimatePosition).value},
                 {"estimate_heading_deg", degrees(as_they_are.of(MotionSource::kEstimateHeading).value)},
                 {"motion", motion},
                 {"calibration", Json::parse(daemon::control::calibration_json(drive.learned))},
                 {"systematic",
                  {{"wheel_scale", json_of_fitted(corrected.wheel_scale)},
                   {"turn_scale", json_of_fitted(corrected.turn_scale)},
                   {"drift_deg_per_m", json_of_fitted(corrected.drift_rad_per_m, radians(1.0))},
                   {"motion_if_corrected", motion_corrected}}}};
  std::cout << all.dump(2) << '\n';
}

void require_enough(const Drive& drive, const std::string& recording) {
  std::ostringstream line;
  line << std::setprecision(3) << recording << ": ";
  if (static_cast<double>(drive.sure_scans) < kLeastSureShare * static_cast<double>(drive.scans)) {
    line << "the pose was sure at " << drive.sure_scans << " of " << drive.scans
         << " scans only: another map, or a start unknown";
    throw std::runtime_error(line.str());
  }
  if (drive.segments.size() < kFewestSegments) {
    line << "too little motion to calibrate from: " << drive.driven_m << " m and " << degrees(drive.turned_rad)
         << " deg with a sure pose, " << drive.segments.size() << " of " << kFewestSegments << " segments";
    throw std::runtime_error(line.str());
  }
}

void run_calibration(CalibrateOptions& options) {
  if (!options.initial_pose.empty())
    options.overrides.push_back("localization.initial_pose=[" + options.initial_pose + "]");
  const daemon::Settings settings = daemon::settings_or_defaults(options.config, options.overrides);
  const Drive drive = driven(options, settings);
  for (const std::string& line : drive.faults.lines()) std::cerr << "deltamap: warning: " << line << '\n';
  require_enough(drive, options.recording);
  const MotionCalibration as_they_are = surveying::calibration::fitted_motion(drive.segments, Systematic::kLeftIn);
  const MotionCalibration corrected = surveying::calibration::fitted_motion(drive.segments, Systematic::kTakenOut);
  if (options.as_json)
    print_calibration_json(as_they_are, corrected, drive);
  else
    print_calibration_text(as_they_are, corrected, drive);
}

}  // namespace

void add_calibrate_motion(CLI::App& calibrate) {
  auto* command = calibrate.add_subcommand("motion", "how far the wheels of a recording can be trusted");
  auto options = std::make_shared<CalibrateOptions>();
  command->add_option("RECORDING", options->recording, "pcapng of both ports")->required();
  command->add_option("--map", options->map, "where it was recorded, map_server YAML")->required();
  command->add_option("--config", options->config, "settings, YAML");
  command->add_option("--initial-pose", options->initial_pose,
                      "X,Y,DEG of the robot in the map at the first scan; over the settings' pose");
  command->add_option("--set", options->overrides, "key=value over the settings; repeatable")->allow_extra_args(false);
  command->add_flag("--json", options->as_json, "print the result as JSON");
  command->callback([options] { run_calibration(*options); });
}

}  // namespace deltamap::tool
