// SPDX-License-Identifier: Apache-2.0
#include "simulation/simulation.hpp"

#include <algorithm>
#include <cmath>

#include "drivers/lms200/measurement.hpp"
#include "simulation/robot/sonar_ring.hpp"
#include "simulation/world/chance.hpp"

namespace deltamap::simulation {
namespace {

namespace lms200 = drivers::lms200;

constexpr Duration kStep = std::chrono::milliseconds{5};
constexpr Duration kTruthEvery = std::chrono::milliseconds{100};
constexpr Duration kForkliftPatience = std::chrono::seconds{1};  // until it looks again where nothing could be done

/// Each has its own chance, so that a change to one does not touch what befalls the others.
enum class LiveChance : std::uint64_t {
  kRobot,
  kLaser,
  kForklift,
  kPioneer,
  kLms200,
  kPeople,
  kCreep,
  kChangedStart,
  kActor,
  kDoor,
  kFaults
};

bool carries_requests(const devices::LineFaults& line) { return !line.is_cut && !line.is_deaf && !line.is_unplugged; }
bool carries_answers(const devices::LineFaults& line) { return !line.is_cut && !line.is_mute && !line.is_unplugged; }

devices::PioneerSetup pioneer_setup(const RobotSetup& robot) {
  devices::PioneerSetup setup;
  setup.model = robot.model;
  setup.baud = robot.baud;
  setup.sip_cycle_s = robot.sip_cycle_s;
  setup.watchdog_s = robot.watchdog_s;
  setup.battery_v = robot.battery_v;
  setup.sonars = robot.sonars;
  setup.has_bumpers = robot.has_bumpers;
  return setup;
}

devices::Lms200Setup lms200_setup(const LaserSetup& laser) {
  devices::Lms200Setup setup;
  setup.baud = laser.baud;
  setup.variant = {static_cast<std::uint16_t>(laser.field_deg),
                   static_cast<std::uint16_t>(std::lround(100.0 * laser.step_deg))};
  setup.has_fixed_variant = laser.field_deg == 90;  // as an LMS291-S14
  setup.units = laser.resolution_m < 0.005 ? lms200::Units::kMillimetre : lms200::Units::kCentimetre;
  const double reach_words = laser.max_range_m / laser.resolution_m;  // B4: 13, 14 or 15 bits
  setup.measuring_mode = reach_words > 16'000 ? 0x06 : reach_words > 8'000 ? 0x04 : 0x00;
  return setup;
}

}  // namespace

Simulation::Simulation(const Scenario& scenario, const SimulationParams& params)
    : scenario_{scenario},
      world_{scenario.world},
      surfaces_{scenario.world},
      body_{scenario.robot.body, scenario.robot.map_from_start, random_for(params.seed, LiveChance::kRobot)},
      range_finder_{scenario.laser.optics, random_for(params.seed, LiveChance::kLaser)},
      faulty_laser_{random_for(params.seed, LiveChance::kFaults)},
      fault_schedule_{scenario.faults},
      movers_{{scenario.people, scenario.actors, scenario.doors}, chance_of_movers<LiveChance>(params.seed)},
      pioneer_{pioneer_setup(scenario.robot), random_for(params.seed, LiveChance::kPioneer)},
      lms200_{lms200_setup(scenario.laser), params.start, random_for(params.seed, LiveChance::kLms200)},
      start_{params.start},
      now_{params.start},
      next_truth_{params.start} {
  if (scenario.forklift) {
    forklift_.emplace(*scenario.forklift, scenario.slots, scenario.world, scenario.robot.map_from_start.position(),
                      random_for(params.seed, LiveChance::kForklift));
    change_every_ = duration_from_seconds(params.change_every_s.value_or(scenario.forklift->change_every_s));
    next_change_ = params.start + change_every_;
  }
  if (scenario.changed_at_start) {
    ChangedHall hall = changed_start(*scenario.changed_at_start, scenario.slots, world_, robot_body(),
                                     movers_.bodies().obstacles(), random_for(params.seed, LiveChance::kChangedStart));
    take_place(hall.changes, params.start);
    for (const Change& change : hall.changes) {
      if (forklift_) forklift_->learn(change);
    }
  }
  if (scenario.creep) {
    creep_.emplace(*scenario.creep, world_, scenario.robot.map_from_start.position(),
                   random_for(params.seed, LiveChance::kCreep));
    next_push_ = params.start + duration_from_seconds(scenario.creep->every_s);
  }
  history_.add({params.start, body_.state().map_from_robot, {}, movers_.bodies()});
}

void Simulation::advance_to(Timestamp now) {
  // The bodies are always moved to the end of the step in which `now` lies, so that everything up to now is known.
  while (history_.newest().time < now) {
    const Timestamp step = history_.newest().time;
    run_devices(std::max(step, now_));
    work(step);
    move(step);
  }
  now_ = std::max(now_, now);
  run_devices(now_);
}

void Simulation::run_devices(Timestamp now) {
  now_ = std::max(now_, now);
  fault_schedule_.apply(seconds(now_ - start_), faults_);
  pioneer_.suffer(faults_.robot_line);
  pioneer_.suffer(faults_.controller, now_);
  lms200_.suffer(faults_.laser_line);
  lms200_.suffer(faults_.laser_unit, now_);
  pioneer_.advance(now, history_.wheels_at(now), [&](int index) { return sonar_range_m(index, now); });
  lms200_.advance(now, [&](const devices::SweepRequest& request) { return measure(request); });
}

FaultOrder Simulation::order(FaultOrder fault) {
  fault.after_s += seconds(now_ - start_);
  fault_schedule_.add(fault);
  return fault;
}

void Simulation::move(Timestamp from) {
  const double dt_s = seconds(kStep);
  body_.suffer(faults_.body);
  body_.move(pioneer_.demand(), dt_s, surfaces_, movers_.bodies().obstacles());
  note_collisions(from + kStep);
  movers_.move(dt_s, surfaces_, robot_body());
  const RobotState& state = body_.state();
  const double counted = faults_.body.counts_nothing ? 0.0 : 1.0;
  const double speed_m_per_s = counted * state.speed_m_per_s;
  const double turn_rate_rad_per_s = counted * state.turn_rate_rad_per_s;
  travelled_m_ += speed_m_per_s * dt_s;
  turned_rad_ += turn_rate_rad_per_s * dt_s;
  history_.add({from + kStep,
                state.map_from_robot,
                {state.odom_from_robot, speed_m_per_s, turn_rate_rad_per_s, travelled_m_, turned_rad_, state.stalled,
                 state.contact ? std::optional{state.contact->bearing_rad} : std::nullopt},
                movers_.bodies()});
}

void Simulation::note_collisions(Timestamp now) {
  const std::size_t before = collisions().size();
  collisions_.observe(now, body_, surfaces_, movers_.bodies().obstacles());
  truth_.insert(truth_.end(), collisions().begin() + static_cast<std::ptrdiff_t>(before), collisions().end());
}

/// What happens at the beginning of a step: what changes the world, and a line of truth now and then.
void Simulation::work(Timestamp now) {
  if (now >= next_truth_) {
    next_truth_ = now + kTruthEvery;
    truth_.push_back(TruthPose{now, body_.state().map_from_robot, body_.state().speed_m_per_s, false});
  }
  for (const MoverEvent& event : movers_.take_events()) truth_.push_back(TruthEvent{now, event});
  let_forklift_work(now);
  let_containers_creep(now);
}

void Simulation::let_forklift_work(Timestamp now) {
  if (!forklift_ || now < next_change_) return;
  const auto change = forklift_->next_change(world_, robot_body(), movers_.bodies().obstacles());
  next_change_ = now + (change ? change_every_ : kForkliftPatience);
  if (change) take_place({*change}, now);
}

void Simulation::let_containers_creep(Timestamp now) {
  if (!creep_ || now < next_push_) return;
  next_push_ = now + duration_from_seconds(scenario_.creep->every_s);
  take_place(creep_->pushes(world_, robot_body(), movers_.bodies().obstacles()), now);
}

void Simulation::take_place(const std::vector<Change>& changes, Timestamp now) {
  if (changes.empty()) return;
  for (const Change& change : changes) {
    world_ = changed(world_, change);
    truth_.push_back(TruthChange{now, change});
  }
  surfaces_ = RayCaster{world_};
}

std::vector<Beam> Simulation::measure(const devices::SweepRequest& request) {
  Sweep sweep;
  for (unsigned beam = 0; beam < request.variant.values(); ++beam) {
    const double angle_deg = request.variant.first_angle_deg() + request.first_angle_shift_deg +
                             0.01 * request.variant.resolution_centideg * beam;
    sweep.bearings_rad.push_back(radians(angle_deg - 90.0));
    sweep.offsets_s.push_back(lms200::beam_offset_s(request.variant, beam));
  }
  const auto at = [&](double offset_s) { return request.begin + duration_from_seconds(offset_s); };
  const auto bodies_at = [&](double offset_s) { return history_.bodies_at(at(offset_s)).surfaces(); };
  const auto readings = faulty_laser_.readings(
      faults_.laser, sweep, request.max_range_m,
      [&](double offset_s) { return history_.map_from_robot_at(at(offset_s)); },
      [&](const Sweep& mounted, const RangeFinder::RobotAt& map_from_robot_at) {
        return range_finder_.measure(mounted, request.max_range_m, surfaces_, map_from_robot_at, bodies_at);
      });
  const devices::WheelMotion wheels = history_.wheels_at(request.begin);
  truth_.push_back(TruthPose{request.begin, history_.map_from_robot_at(request.begin), wheels.speed_m_per_s, true});
  std::vector<Beam> beams;
  for (std::size_t i = 0; i < readings.size(); ++i) {
    beams.push_back(
        {static_cast<float>(readings[i].range_m), static_cast<float>(sweep.offsets_s[i]), readings[i].kind});
  }
  return beams;
}

/// The nearest echo within the sonar's cone of 15°.
std::optional<double> Simulation::sonar_range_m(int index, Timestamp now) const {
  constexpr double kReach_m = 5.0;
  const Pose2 map_from_sonar = history_.map_from_robot_at(now) * robot_from_sonar(index);
  std::optional<double> nearest;
  for (const double off_deg : {-7.5, 0.0, 7.5}) {
    const auto hit = surfaces_.cast(map_from_sonar.position(), map_from_sonar.theta + radians(off_deg), kReach_m,
                                    history_.bodies_at(now).surfaces());
    if (hit && (!nearest || hit->range_m < *nearest)) nearest = hit->range_m;
  }
  return nearest;
}

Circle Simulation::robot_body() const {
  return {body_.state().map_from_robot.position(), scenario_.robot.body.radius_m};
}

Timestamp Simulation::next_event() const {
  Timestamp next = history_.newest().time > now_ ? history_.newest().time : now_ + kStep;
  for (const auto& event : {pioneer_.next_event(), lms200_.next_event()}) {
    if (event && *event > now_) next = std::min(next, *event);
  }
  return next;
}

void Simulation::send_to_robot(std::span<const std::uint8_t> bytes, unsigned host_baud) {
  if (carries_requests(faults_.robot_line)) pioneer_.receive(bytes, host_baud, now_);
}

void Simulation::send_to_laser(std::span<const std::uint8_t> bytes, unsigned host_baud) {
  if (carries_requests(faults_.laser_line)) lms200_.receive(bytes, host_baud, now_);
}

std::vector<std::uint8_t> Simulation::bytes_from_robot(unsigned host_baud) {
  auto bytes = pioneer_.transmitted(now_, host_baud);
  if (!carries_answers(faults_.robot_line)) bytes.clear();
  return bytes;
}

std::vector<std::uint8_t> Simulation::bytes_from_laser(unsigned host_baud) {
  auto bytes = lms200_.transmitted(now_, host_baud);
  if (!carries_answers(faults_.laser_line)) bytes.clear();
  return bytes;
}

std::vector<TruthRecord> Simulation::take_truth() {
  std::vector<TruthRecord> taken;
  taken.swap(truth_);
  return taken;
}

}  // namespace deltamap::simulation
