// SPDX-License-Identifier: Apache-2.0
#include "simulation/virtual_drive.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "drivers/lms200/measurement.hpp"
#include "simulation/changes/changed_hall.hpp"
#include "simulation/world/chance.hpp"

namespace deltamap::simulation {
namespace {

constexpr Timestamp kStart = timestamp_from_ns(1'700'000'000'000'000'000);
constexpr double kLeastThought_s = 0.05;  // between two decisions of the pilot
constexpr double kMostThought_s = 0.2;
constexpr double kStep_s = 0.01;                  // of bodies, at most
constexpr double kForkliftPatience_s = 1.0;       // until it looks again where nothing could be done
constexpr double kBodyRoom_m = 0.2;               // between the robot's body and what stands around it
constexpr double kWheelUnit_m = 0.001;            // of a p3dx-sh's position and wheel speeds (A7)
constexpr double kHeadingUnit_rad = 0.001534;     // A6
constexpr double kLongestInMillimetres_m = 32.0;  // B4

/// Each has its own chance, so that a change to one does not touch what befalls the others.
enum class DriveChance : std::uint64_t {
  kRobot,
  kLaser,
  kForklift,
  kPilot,
  kPeople,
  kMany,
  kCreep,
  kChangedStart,
  kActor,
  kDoor,
  kSlips,
  kGaps,
  kSight
};

double rounded_to(double value, double unit) { return unit * std::round(value / unit); }

Scenario started_at(Scenario scenario, const std::optional<Pose2>& map_from_start) {
  if (map_from_start) scenario.robot.map_from_start = *map_from_start;
  return scenario;
}

MoverParams movers_of(const Scenario& scenario, const std::vector<PersonParams>& more_people) {
  MoverParams movers{scenario.people, scenario.actors, scenario.doors};
  movers.people.insert(movers.people.end(), more_people.begin(), more_people.end());
  return movers;
}

Sweep sweep_of(const drivers::lms200::ScanVariant& fan) {
  Sweep sweep;
  for (unsigned beam = 0; beam < fan.values(); ++beam) {
    const double angle_deg = fan.first_angle_deg() + 0.01 * fan.resolution_centideg * beam;
    sweep.bearings_rad.push_back(radians(angle_deg - 90.0));
    sweep.offsets_s.push_back(drivers::lms200::beam_offset_s(fan, beam));
  }
  return sweep;
}

/// A raster takes half a turn of the mirror; while it looks backwards it measures nothing.
double duration_s(const drivers::lms200::ScanVariant& fan) {
  return fan.scan_duration_s() - 0.5 * drivers::lms200::kMirrorTurnS;
}

double exponential(double mean, Random& random) { return -mean * std::log(1.0 - random.uniform()); }

}  // namespace

VirtualDrive::VirtualDrive(const Scenario& scenario, const VirtualDriveParams& params)
    : scenario_{started_at(scenario, params.map_from_start)},
      params_{params},
      world_{scenario.world},
      surfaces_{scenario.world},
      body_{scenario.robot.body, scenario_.robot.map_from_start, random_for(params.seed, DriveChance::kRobot)},
      range_finder_{scenario.laser.optics, random_for(params.seed, DriveChance::kLaser)},
      pilot_{params.route, scenario.world, scenario_.robot.map_from_start.position(),
             random_for(params.seed, DriveChance::kPilot)},
      movers_{movers_of(scenario, params.people), chance_of_movers<DriveChance>(params.seed)},
      now_{kStart},
      next_odometry_{kStart},
      next_change_{kStart},
      next_push_{kStart},
      next_thought_{kStart},
      gap_chance_{random_for(params.seed, DriveChance::kGaps)},
      sight_chance_{random_for(params.seed, DriveChance::kSight)},
      fan_{sweep_of(params.fan)},
      sweep_s_{duration_s(params.fan)} {
  if (params.slips) slips_.emplace(*params.slips, random_for(params.seed, DriveChance::kSlips));
  if (params.gaps) next_gap_ = kStart + duration_from_seconds(exponential(params.gaps->every_s, gap_chance_));
  if (params.forklift) {
    forklift_.emplace(*params.forklift, scenario.slots, scenario.world, scenario_.robot.map_from_start.position(),
                      random_for(params.seed, DriveChance::kForklift));
    next_change_ = kStart + duration_from_seconds(params.forklift->change_every_s);
  }
  const auto& start = params.changed_at_start ? params.changed_at_start : scenario.changed_at_start;
  if (start) begin_changed(*start);
  if (!params.changes_at_start.empty()) {
    for (const Change& change : params.changes_at_start) note_unseen(change);
    see_changes();
  }
  if (params.creep) {
    creep_.emplace(*params.creep, world_, scenario_.robot.map_from_start.position(),
                   random_for(params.seed, DriveChance::kCreep));
    next_push_ = kStart + duration_from_seconds(params.creep->every_s);
  }
}

void VirtualDrive::begin_changed(const ChangedStartParams& start) {
  ChangedHall hall = changed_start(start, scenario_.slots, world_, robot_body(), movers_.bodies().obstacles(),
                                   random_for(params_.seed, DriveChance::kChangedStart));
  world_ = std::move(hall.world);
  unseen_ = std::move(hall.changes);
  for (const Change& change : unseen_) {
    if (forklift_) forklift_->learn(change);
  }
  see_changes();
}

void VirtualDrive::note_unseen(const Change& change) {
  world_ = changed(world_, change);
  if (forklift_) forklift_->learn(change);
  unseen_.push_back(change);
}

DriveStep VirtualDrive::next() {
  step_ = {};
  step_.changes = std::exchange(unseen_, {});
  if (next_gap_ && now_ >= *next_gap_) wait_without_scans();
  let_forklift_work();
  let_containers_creep();
  think();
  const Timestamp end = now_ + duration_from_seconds(params_.scan_period_s);
  step_.map_from_robot = body_.state().map_from_robot;
  step_.scan = sweep();
  drive_until(end);
  step_.scan.received = now_;
  step_.events = movers_.take_events();
  return std::move(step_);
}

void VirtualDrive::wait_without_scans() {
  const GapParams& gaps = *params_.gaps;
  const double length_s = gaps.least_s * std::pow(gaps.most_s / gaps.least_s, gap_chance_.uniform());
  const Timestamp end = now_ + duration_from_seconds(length_s);
  while (now_ < end) {
    let_forklift_work();
    let_containers_creep();
    think();
    drive_until(std::min(end, now_ + duration_from_seconds(kMostThought_s)));
  }
  next_gap_ = end + duration_from_seconds(exponential(gaps.every_s, gap_chance_));
}

void VirtualDrive::think() {
  if (now_ < next_thought_) return;
  const double thought_s = std::clamp(params_.scan_period_s, kLeastThought_s, kMostThought_s);
  next_thought_ = now_ + duration_from_seconds(thought_s);
  target_ = held_ ? *held_ : pilot_.target(body_.state(), movers_.bodies(), thought_s);
}

void VirtualDrive::drive_until(Timestamp end) {
  while (now_ < end) {
    if (now_ >= next_thought_) think();
    advance(std::min(kStep_s, seconds(end - now_)));
  }
}

/// The robot moves while the mirror turns: between where it is at the sweep's begin and at its end.
Scan VirtualDrive::sweep() {
  Scan scan;
  scan.time = now_;
  scan.number = scans_++;
  scan.first_bearing_rad = fan_.bearings_rad.front();
  scan.bearing_step_rad = radians(0.01 * params_.fan.resolution_centideg);
  scan.max_range_m = params_.max_range_m;
  scan.robot_from_laser = params_.told_mount.value_or(scenario_.laser.optics.robot_from_laser);
  const Bodies standing = movers_.bodies();
  const Pose2 begin = body_.state().map_from_robot;
  const int pieces = 1 + static_cast<int>(sweep_s_ / kStep_s);
  for (int i = 0; i < pieces; ++i) advance(sweep_s_ / pieces);
  const Pose2 end = body_.state().map_from_robot;
  const auto readings = range_finder_.measure(
      fan_, params_.max_range_m, surfaces_,
      [&](double offset_s) { return interpolated(begin, end, offset_s / sweep_s_); },
      [&](double) { return standing.surfaces(); });
  const double unit_m = params_.max_range_m > kLongestInMillimetres_m ? 0.01 : 0.001;
  scan.beams.reserve(readings.size());
  for (std::size_t i = 0; i < readings.size(); ++i) {
    scan.beams.push_back({static_cast<float>(rounded_to(readings[i].range_m, unit_m)),
                          static_cast<float>(fan_.offsets_s[i]), readings[i].kind});
  }
  return scan;
}

void VirtualDrive::advance(double dt_s) {
  const RobotState before = body_.state();
  const Timestamp from = now_;
  body_.move(target_, dt_s, surfaces_, movers_.bodies().obstacles());
  if (slips_) {
    const int before_this = slips_->begun();
    body_.spin_wheels(slips_->observe(std::abs(body_.state().speed_m_per_s) * dt_s, dt_s));
    step_.slips += slips_->begun() - before_this;
  }
  movers_.move(dt_s, surfaces_, robot_body());
  now_ = now_ + duration_from_seconds(dt_s);
  report_odometry(before, from);
}

void VirtualDrive::report_odometry(const RobotState& before, Timestamp from) {
  while (next_odometry_ <= now_) {
    const RobotState& after = body_.state();
    const double share = seconds(next_odometry_ - from) / seconds(now_ - from);
    const Pose2 odom = interpolated(before.odom_from_robot, after.odom_from_robot, share);
    Odometry odometry;
    odometry.time = next_odometry_ + duration_from_seconds(params_.odometry_lag_s);
    odometry.odom_from_robot = {rounded_to(odom.x, kWheelUnit_m), rounded_to(odom.y, kWheelUnit_m),
                                wrapped_angle(rounded_to(odom.theta, kHeadingUnit_rad))};
    const double half_track_m = scenario_.robot.body.half_track_m;
    const double turning_m_per_s = after.turn_rate_rad_per_s * half_track_m;
    const double left_m_per_s = rounded_to(after.speed_m_per_s - turning_m_per_s, kWheelUnit_m);
    const double right_m_per_s = rounded_to(after.speed_m_per_s + turning_m_per_s, kWheelUnit_m);
    odometry.speed_m_per_s = 0.5 * (left_m_per_s + right_m_per_s);
    odometry.turn_rate_rad_per_s = (right_m_per_s - left_m_per_s) / (2.0 * half_track_m);
    odometry.motors_enabled = true;
    odometry.stalled = after.stalled;
    odometry.battery_v = scenario_.robot.battery_v;
    under_way_.push_back(odometry);
    next_odometry_ = next_odometry_ + duration_from_seconds(params_.odometry_period_s);
  }
  while (!under_way_.empty() && under_way_.front().time <= now_) {
    step_.odometry.push_back(under_way_.front());
    under_way_.pop_front();
  }
}

void VirtualDrive::let_forklift_work() {
  if (!forklift_ || now_ < next_change_) return;
  const bool may_be_seen = sight_chance_.uniform() < params_.change_in_view_share;
  const Forklift::MayTouch out_of_sight = [this](const Box& box) { return is_out_of_sight(box); };
  const auto done = forklift_->next_change(world_, robot_body(), movers_.bodies().obstacles(),
                                           may_be_seen ? Forklift::MayTouch{} : out_of_sight);
  next_change_ = now_ + duration_from_seconds(done ? params_.forklift->change_every_s : kForkliftPatience_s);
  if (!done) return;
  change(*done);
  step_.changes.push_back(*done);
}

/// No corner and no middle of a side can be seen from where the robot is, whichever way it looks.
bool VirtualDrive::is_out_of_sight(const Box& box) const {
  const Point2 eye = body_.state().map_from_robot.position();
  const auto is_hidden = [&](const Point2& point) {
    constexpr double kBefore_m = 0.05;  // a beam that ends so near has met the thing itself
    const Point2 way = point - eye;
    const double away_m = way.norm();
    return away_m > params_.max_range_m ||
           surfaces_.cast(eye, std::atan2(way.y(), way.x()), std::max(0.0, away_m - kBefore_m)).has_value();
  };
  const auto sides = faces(box);
  return std::all_of(sides.begin(), sides.end(), [&](const Segment& side) {
    return is_hidden(side.from) && is_hidden(0.5 * (side.from + side.to));
  });
}

void VirtualDrive::let_containers_creep() {
  if (!creep_ || now_ < next_push_) return;
  next_push_ = now_ + duration_from_seconds(params_.creep->every_s);
  const std::vector<Change> pushes = creep_->pushes(world_, robot_body(), movers_.bodies().obstacles());
  if (pushes.empty()) return;
  for (const Change& push : pushes) world_ = changed(world_, push);
  see_changes();
  step_.changes.insert(step_.changes.end(), pushes.begin(), pushes.end());
}

void VirtualDrive::kidnap(const Pose2& map_from_robot) { body_.carry_to(map_from_robot); }

void VirtualDrive::change(const Change& change) {
  world_ = changed(world_, change);
  see_changes();
}

void VirtualDrive::see_changes() {
  surfaces_ = RayCaster{world_};
  pilot_.see(world_, body_.state().map_from_robot.position());
}

std::vector<Change> VirtualDrive::change_many(double share, const ForkliftParams& params) {
  ChangedHall hall = changed_hall({.share = share}, params, scenario_.slots, scenario_.world, world_, robot_body(),
                                  movers_.bodies().obstacles(), random_for(params_.seed, DriveChance::kMany, many_++));
  world_ = std::move(hall.world);
  see_changes();
  return hall.changes;
}

Circle VirtualDrive::robot_body() const {
  return {body_.state().map_from_robot.position(), scenario_.robot.body.radius_m};
}

bool VirtualDrive::is_free(const Point2& place) const {
  const double room_m = scenario_.robot.body.radius_m + kBodyRoom_m;
  if (surfaces_.nearest_surface(place, room_m)) return false;
  const auto inside = [&](const Object& object) { return distance_between(place, object.shape) < room_m; };
  if (std::any_of(world_.objects.begin(), world_.objects.end(), inside)) return false;
  const auto standing = movers_.bodies().obstacles();
  return std::none_of(standing.begin(), standing.end(),
                      [&](const Circle& person) { return (person.centre - place).norm() < room_m + person.radius_m; });
}

Pose2 VirtualDrive::place_anywhere(Random& random) const {
  Pose2 place = pilot_.place_anywhere(random);
  while (!is_free(place.position())) place = pilot_.place_anywhere(random);
  return place;
}

}  // namespace deltamap::simulation
