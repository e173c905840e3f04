// SPDX-License-Identifier: Apache-2.0
#include "experiments/closed_loop/driver_trial.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>

#include "experiments/closed_loop/frame_witness.hpp"
#include "experiments/closed_loop/loop_run.hpp"
#include "experiments/closed_loop/virtual_daemon.hpp"

namespace deltamap::experiments {
namespace {

using simulation::NamedFault;

constexpr Timestamp kDriverTrialStart = timestamp_from_ns(1'700'000'000'000'000'000);
constexpr double kSettledS = 12.0;     // from the start until both devices deliver
constexpr double kBackSoonS = 3.0;     // after the end of a fault
constexpr double kPowerCycleS = 60.0;  // of a laser that starts up
constexpr double kPatienceS = 30.0;    // then it counts as never
constexpr double kPauseS = 1.5;        // between faults: it drives again
constexpr double kMomentS = 0.01;      // what is over in a moment has happened
constexpr double kFreshOdometryS = 0.35;
constexpr double kFreshScanS = 0.5;
constexpr double kLookPeriodS = 0.1;
// When the robot must stand, and how long it may need to come to stand: what is noticed, and braking from full speed.
constexpr double kWithoutScansS = 2.5;
constexpr double kWithoutOdometryS = 5.0;  // its own watchdog has 2 s
constexpr double kUntilAPersonS = 3.0;
constexpr double kStandsMPerS = 0.02;

/// They change what the scans mean, or where the body is: without a map nobody can tell.
constexpr std::array<std::string_view, 16> kNeedMap{"laser-turned",
                                                    "laser-upside-down",
                                                    "laser-covered-ahead",
                                                    "laser-covered-left",
                                                    "laser-covered-right",
                                                    "laser-post",
                                                    "laser-scaled",
                                                    "laser-stands",
                                                    "laser-elsewhere",
                                                    "laser-random",
                                                    "wheels-slip",
                                                    "left-wheel-spins",
                                                    "right-wheel-spins",
                                                    "pushed",
                                                    "towed",
                                                    "turned-by-hand"};
/// Afterwards it stands until a person says that it may drive (docs/operating/why-it-stands.md). Of others the log says
/// so.
constexpr std::array<std::string_view, 7> kNeedPerson{"stop-button", "motors-button",    "estall",     "bumper",
                                                      "stall",       "controller-fault", "laser-error"};
constexpr std::string_view kWaitsForAPerson = "a person says drive";

template <typename Names>
bool is_among(const Names& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Round its usual number, and for bauds one of those that there are.
double drawn_number(const NamedFault& fault, Random& random) {
  constexpr std::array<double, 4> kBauds{9600.0, 19200.0, 57600.0, 115200.0};
  if (fault.unit == "baud") return kBauds[random.index_below(kBauds.size())];
  if (fault.unit == "segment" || fault.unit == "code" || fault.unit == "severity" || fault.unit == "flags")
    return fault.usual;
  if (fault.name == "laser-restarts") return std::round(random.uniform(1.0, 50.0));
  if (fault.name == "clock-leaps") return random.uniform(-10.0, 10.0);
  return std::clamp(fault.usual * random.uniform(0.5, 2.0), fault.least, fault.most);
}

class Drive {
 public:
  Drive(const DriverTrial& trial, const simulation::Scenario& scenario, daemon::Settings settings)
      : trial_{trial},
        random_{trial.seed},
        world_{scenario, {trial.seed, kDriverTrialStart, std::nullopt}},
        witness_{world_, settings.laser.session.max_range_m},
        daemon_{world_, {.settings = std::move(settings)}} {
    daemon_.set_listener([this](VirtualDaemon::Bytes from_robot, VirtualDaemon::Bytes from_laser) {
      witness_.hear(from_robot, from_laser, daemon_.host_time());
    });
  }

  DriverTrialOutcome outcome() {
    daemon_.start();
    pass(kSettledS);
    while (since_start_s() < trial_.for_s) {
      (void)daemon_.operator_says(true);
      needs_person_since_.reset();
      pass(random_.uniform(0.5, 1.0) * kPauseS);
      go_wrong();
    }
    outcome_.wrong_frames = witness_.wrong_frames();
    outcome_.wrong_scans = witness_.wrong_scans();
    for (const simulation::Collision& collision : world_.collisions())
      outcome_.collisions += std::abs(collision.speed_m_per_s) > kStandsMPerS ? 1 : 0;
    return std::move(outcome_);
  }

 private:
  [[nodiscard]] double since_start_s() const { return seconds(world_.now() - kDriverTrialStart); }

  void pass(double duration_s) {
    daemon_.run(duration_s, [this] { look(); });
  }

  void go_wrong() {
    const std::string_view name = trial_.faults[random_.index_below(static_cast<std::uint32_t>(trial_.faults.size()))];
    const auto all = simulation::named_faults();
    const NamedFault& fault =
        *std::find_if(all.begin(), all.end(), [&](const NamedFault& one) { return one.name == name; });
    const bool is_long_silence = fault.name.ends_with("cable-cut") && random_.uniform() < 0.1;
    const double lasts_s = fault.is_momentary() ? 0.0 : is_long_silence ? 60.0 : random_.uniform(0.3, 10.0);
    const double number = drawn_number(fault, random_);
    TriedDriverFault tried;
    tried.name = name;
    tried.begins_s = since_start_s();
    tried.order = text_of(fault, number, lasts_s);
    fault_ = tried.name;
    const std::size_t first_line = daemon_.log().size();
    if (is_among(kNeedPerson, name)) needs_person_since_ = world_.now();
    fault.set(world_.faults(), number);
    pass(std::max(kMomentS, lasts_s));
    if (!fault.is_momentary()) fault.clear(world_.faults());
    const bool starts_up = name == "laser-restarts";
    const double most_s = starts_up ? kPowerCycleS : kBackSoonS;
    tried.back_after_s = time_until_back_s(starts_up ? kPowerCycleS + kPatienceS : kPatienceS);
    tried.is_back_soon = tried.back_after_s <= most_s;
    pass(kPauseS);
    tried.lasted_s = lasts_s;
    for (std::size_t i = first_line; i < daemon_.log().size(); ++i) {
      if (!is_of_speed(daemon_.log()[i])) tried.lines.push_back(daemon_.log()[i]);
    }
    outcome_.faults.push_back(std::move(tried));
  }

  /// It drives slowly until scans have shown its wheels, whatever goes wrong.
  static bool is_of_speed(const std::string& line) {
    return line.starts_with("driving at full speed") || line.starts_with("driving slowly");
  }
  static std::string text_of(const NamedFault& fault, double number, double lasts_s) {
    char text[96];
    std::string order{fault.name};
    if (!fault.unit.empty()) {
      (void)std::snprintf(text, sizeof text, ":%g", number);
      order += text;
    }
    if (fault.is_momentary()) return order;
    (void)std::snprintf(text, sizeof text, ":%.2f", lasts_s);
    return order + text;
  }

  [[nodiscard]] bool is_back() const {
    const Timestamp now = daemon_.host_time();
    return daemon_.is_connected() && daemon_.is_streaming() && daemon_.last_scan() &&
           seconds(now - daemon_.last_odometry()) <= kFreshOdometryS &&
           seconds(now - daemon_.last_scan()->received) <= kFreshScanS;
  }
  double time_until_back_s(double patience_s) {
    constexpr double kStepS = 0.05;
    const Timestamp began = daemon_.host_time();
    // What was delivered before the end of the fault proves nothing.
    const auto is_new = [&] { return daemon_.last_odometry() > began && daemon_.last_scan()->received > began; };
    while (!(is_back() && is_new()) && seconds(daemon_.host_time() - began) < patience_s) pass(kStepS);
    return seconds(daemon_.host_time() - began);
  }

  void look() {
    for (; read_ < daemon_.log().size(); ++read_) {
      if (!needs_person_since_ && daemon_.log()[read_].find(kWaitsForAPerson) != std::string::npos)
        needs_person_since_ = world_.now();
    }
    if (daemon_.last_scan() && daemon_.last_scan()->number != judged_) {
      judged_ = daemon_.last_scan()->number;
      witness_.judge(*daemon_.last_scan());
      scan_at_ = world_.now();
    }
    if (daemon_.last_odometry() != odometry_) {
      odometry_ = daemon_.last_odometry();
      odometry_at_ = world_.now();
    }
    const double passed_s = seconds(world_.now() - looked_);
    if (passed_s < kLookPeriodS) return;
    const Pose2 pose = world_.map_from_robot();
    const double moved_m = distance_between(pose, pose_);
    pose_ = pose;
    looked_ = world_.now();
    outcome_.moved_m += moved_m;
    const std::string why = why_it_must_stand();
    if (moved_m / passed_s > kStandsMPerS && !why.empty() && passed_s < 10.0 * kLookPeriodS) complain(why);
  }

  [[nodiscard]] std::string why_it_must_stand() const {
    const Timestamp now = world_.now();
    if (seconds(now - scan_at_) > kWithoutScansS) return "without scans";
    if (seconds(now - odometry_at_) > kWithoutOdometryS) return "without odometry";
    if (needs_person_since_ && seconds(now - *needs_person_since_) > kUntilAPersonS) return "before a person says so";
    return {};
  }
  void complain(const std::string& why) {
    const std::string text = fault_ + ": it moves " + why;
    if (outcome_.forbidden.empty() || outcome_.forbidden.back() != text) outcome_.forbidden.push_back(text);
  }

  DriverTrial trial_;
  Random random_;
  simulation::Simulation world_;
  FrameWitness witness_;
  VirtualDaemon daemon_;
  DriverTrialOutcome outcome_;
  std::string fault_ = "none";
  std::optional<Timestamp> needs_person_since_;
  std::size_t read_ = 0;  // lines of the log
  std::uint32_t judged_ = 0xFFFF'FFFF;
  Timestamp odometry_{};
  Timestamp scan_at_ = kDriverTrialStart;
  Timestamp odometry_at_ = kDriverTrialStart;
  Timestamp looked_ = kDriverTrialStart;
  Pose2 pose_ = world_.map_from_robot();
};

}  // namespace

std::vector<std::string_view> driver_faults() {
  std::vector<std::string_view> names;
  for (const NamedFault& fault : simulation::named_faults()) {
    if (!is_among(kNeedMap, fault.name)) names.push_back(fault.name);
  }
  return names;
}

DriverTrialOutcome outcome_of(const DriverTrial& trial, const simulation::Scenario& scenario,
                              const daemon::Settings& settings) {
  return Drive{trial, scenario, fitting(scenario, settings)}.outcome();
}

}  // namespace deltamap::experiments
