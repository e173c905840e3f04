// SPDX-License-Identifier: Apache-2.0
#include "daemon/pipeline.hpp"

#include <chrono>
#include <vector>

#include "core/channel.hpp"
#include "core/grid_file.hpp"
#include "daemon/latency_histogram.hpp"
#include "daemon/map_step.hpp"
#include "daemon/recorder.hpp"
#include "daemon/revision_keeper.hpp"
#include "daemon/stage.hpp"
#include "drivers/port/port_clock.hpp"
#include "mapping/store_scan.hpp"
#include "navigation/wander.hpp"

namespace deltamap::daemon {
namespace {

using Kind = Decision::Kind;

constexpr int kMapNiceness = 15;  // a map update never makes a scan wait, even on one processor
constexpr int kRecorderNiceness = 5;

std::filesystem::path in_folder(const std::optional<std::filesystem::path>& folder, const char* name) {
  return folder ? *folder / name : std::filesystem::path{};
}

/// A history that begins with this run; nothing where the settings keep theirs in the same file.
std::optional<mapping::MapStore> begun_store(const std::filesystem::path& file, const OccupancyGrid& start,
                                             const std::filesystem::path& configured) {
  std::error_code ignored;
  if (!configured.empty() && std::filesystem::equivalent(file, configured, ignored)) return std::nullopt;
  for (const char* part : {"", "-wal", "-shm"}) std::filesystem::remove(file.string() + part, ignored);
  return mapping::MapStore{file, start};
}

std::optional<std::size_t> newest_scan_in(const std::vector<SensorMessage>& batch) {
  for (std::size_t i = batch.size(); i-- > 0;) {
    if (std::holds_alternative<Scan>(batch[i])) return i;
  }
  return std::nullopt;
}

}  // namespace

struct Pipeline::State {
  State(const Settings& given, Options wanted);

  // --- the flow: channel, thread, channel, thread ... (capacity: what is lost where it is full) ---

  Settings settings;
  Options options;
  Telemetry telemetry;
  Recorder recorder;

  Channel<SensorMessage> sensors{128};  // io → localization: the newest message, journaled
  Channel<TrackedScan> tracked_scans{
      128};                           // localization → delta: the newest scan is not looked at for changes, journaled
  Channel<ScanSet> sets{2};           // delta → map: one more waits in the delta thread, the next is lost, journaled
  Channel<MapRevision> revisions{4};  // map → localization: a gap in numbers, which the localizer bridges

  IoStage io;               // bytes → Odometry, Scan
  void localize();          // Odometry, Scan, MapRevision → TrackedScan, DriveCommand
  void look_for_changes();  // TrackedScan → ScanSet
  void update_maps();       // ScanSet → MapRevision

  // --- what each thread owns ---

  LocalizationStep localization;
  std::optional<navigation::Wander> pilot;
  LatencyHistogram latency;
  mapping::StoreScan store_scan;
  std::optional<ScanSet> waiting_set;  // the map thread was busy: offered again at the next scan
  MapStep map_step;
  mapping::MapStore* store;                    // of the settings; null after it has failed
  std::optional<mapping::MapStore> out_store;  // of --out: begins with this run
  std::optional<LineFile> changes;
  std::vector<ChangeNote> change_notes;

  void work_off(std::vector<SensorMessage>& batch);
  void localize(Scan scan);
  void pass_over(const Scan& scan);
  void show(const Estimate& estimate, Timestamp received);
  void hand_over(ScanSet set);
  void update_map(const ScanSet& set);
  void save(const MapStep::Result& result);
  void note(RecorderInput& input, const Decision& decision) { (void)input.send(note_of(decision)); }
  void end_threads();

  Workload localization_work, awareness_work, map_work;
  double wall_began_s = 0.0;
  std::unique_ptr<Stage> io_thread, localization_thread, awareness_thread, map_thread, recorder_thread;
  bool ended = false;
};

Pipeline::State::State(const Settings& given, Options wanted)
    : settings{given},
      options{std::move(wanted)},
      recorder{{.recording = settings.recording.file,
                .bauds = {settings.robot.session.baud, settings.laser.session.baud},
                .began = drivers::port::port_clock_now(),
                .first_note = note_of(RunIdentity{settings_fingerprint(settings), grid_hash(*options.start.map)}),
                .max_gigabytes = settings.recording.max_gigabytes,
                .trajectory = in_folder(options.out, "trajectory.tum")},
               telemetry,
               options.log},
      io{settings,
         {.open = options.open,
          .mode = options.mode,
          .sensors = sensors,
          .recorder = recorder.from_io(),
          .telemetry = telemetry,
          .log = options.log}},
      localization{settings, options.start},
      store_scan{settings.mapping.store_scan, settings.seed},
      map_step{settings, options.start},
      store{options.store} {
  if (settings.navigation.mode == navigation::DriveMode::kWander) {
    pilot.emplace(settings.navigation.wander, settings.seed);
  }
  if (options.out) {
    changes.emplace(*options.out / "changes.jsonl");
    out_store = begun_store(*options.out / "map_store.sqlite", *options.start.map, settings.map.store);
    write_grid(*options.start.map, *options.out / "map.yaml");
  }
  telemetry.newest_revision.set(options.start.revision);
  telemetry.revision.set(options.start.revision);
  wall_began_s = seconds(drivers::port::port_clock_now().time_since_epoch());

  // Receivers before senders.
  recorder_thread = std::make_unique<Stage>(
      Stage::Options{"recorder", kRecorderNiceness}, [this] { recorder.run(); }, options.failed);
  map_thread = std::make_unique<Stage>(
      Stage::Options{"map", kMapNiceness}, [this] { update_maps(); }, options.failed);
  awareness_thread = std::make_unique<Stage>(
      Stage::Options{"delta", 0}, [this] { look_for_changes(); }, options.failed);
  localization_thread = std::make_unique<Stage>(
      Stage::Options{"localization", 0}, [this] { localize(); }, options.failed);
  io_thread = std::make_unique<Stage>(
      Stage::Options{"io", 0}, [this] { io.run(); }, options.failed);
}

// --- localization thread ---

void Pipeline::State::localize() {
  std::vector<SensorMessage> batch;
  batch.reserve(sensors.capacity());
  while (auto message = sensors.receive()) {
    // After a stall the queue is drained: all odometry counts, of the scans only the newest.
    const Workload::Item item{localization_work};
    batch.clear();
    batch.push_back(std::move(*message));
    while (batch.size() < sensors.capacity()) {
      auto more = sensors.try_receive();
      if (!more) break;
      batch.push_back(std::move(*more));
    }
    work_off(batch);
  }
}

void Pipeline::State::work_off(std::vector<SensorMessage>& batch) {
  const auto newest_scan = newest_scan_in(batch);
  for (std::size_t i = 0; i < batch.size(); ++i) {
    if (const auto* odometry = std::get_if<Odometry>(&batch[i])) {
      localization.observe(*odometry);
    } else if (i == newest_scan) {
      localize(std::move(std::get<Scan>(batch[i])));
    } else {
      pass_over(std::get<Scan>(batch[i]));
    }
  }
}

void Pipeline::State::pass_over(const Scan& scan) {
  telemetry.dropped.add(1);
  note(recorder.from_localization(), {Kind::kScanDropped, scan.number, 0});
  (void)recorder.from_localization().send(localization.pass_over(scan));
}

void Pipeline::State::localize(Scan scan) {
  const std::uint32_t number = scan.number;
  while (const auto revision = revisions.try_receive()) {
    localization.apply(*revision);
    // Counted from the start of the run, as a replay does.
    note(recorder.from_localization(), {Kind::kRevision, number, revision->number - options.start.revision});
  }
  TrackedScan tracked = localization.observe(std::move(scan));
  show(tracked.estimate, tracked.scan.received);
  (void)recorder.from_localization().send(TrajectoryPoint{tracked.scan.time, tracked.estimate.map_from_robot});
  if (pilot) io.post(pilot->step(tracked));
  if (!settings.mapping.enabled || tracked_scans.try_send(std::move(tracked))) return;
  telemetry.tracked_lost.add(1);
  note(recorder.from_localization(), {Kind::kTrackedLost, number, 0});
}

void Pipeline::State::show(const Estimate& estimate, Timestamp received) {
  const double latency_s = seconds(drivers::port::port_clock_now() - received);
  latency.add(latency_s);
  telemetry.localized.add(1);
  telemetry.latency_s.set(latency_s);
  telemetry.x_m.set(estimate.map_from_robot.x);
  telemetry.y_m.set(estimate.map_from_robot.y);
  telemetry.heading_rad.set(estimate.map_from_robot.theta);
  telemetry.n_eff.set(estimate.n_eff);
  telemetry.w_avg.set(estimate.w_avg);
  telemetry.particles.set(estimate.particles);
  telemetry.revision.set(estimate.revision);
  telemetry.state.set(static_cast<std::uint8_t>(estimate.state));
}

// --- delta thread ---

void Pipeline::State::look_for_changes() {
  while (const auto tracked = tracked_scans.receive()) {
    const Workload::Item item{awareness_work};
    if (waiting_set && sets.try_send(std::move(*waiting_set))) waiting_set.reset();
    auto set = store_scan.observe(*tracked);
    const mapping::Awareness& awareness = store_scan.awareness();
    telemetry.r_d.set(awareness.r_d);
    telemetry.in_phase.set(awareness.in_phase);
    telemetry.phase.set(awareness.phase);
    telemetry.stored_scans.set(awareness.stored_scans);
    if (!set) continue;
    telemetry.phases_closed.add(1);
    note(recorder.from_awareness(), {Kind::kPhaseClosed, tracked->scan.number, set->phase});
    hand_over(std::move(*set));
  }
}

void Pipeline::State::hand_over(ScanSet set) {
  if (waiting_set) {
    telemetry.sets_lost.add(1);
    note(recorder.from_awareness(), {Kind::kSetLost, 0, set.phase});
  } else if (!sets.try_send(std::move(set))) {
    waiting_set = std::move(set);
  }
}

// --- map thread ---

void Pipeline::State::update_maps() {
  while (const auto set = sets.receive()) update_map(*set);
  // The delta thread has ended: what it could not hand over is worked off too.
  if (waiting_set) update_map(*waiting_set);
}

void Pipeline::State::update_map(const ScanSet& set) {
  const Workload::Item item{map_work};
  MapStep::Result result = map_step.update(set);
  if (changes) {
    changes->write(json_line(result.note));
    changes->flush();
  }
  change_notes.push_back(result.note);
  if (!result.revision) {
    telemetry.refused.add(1);
    options.log("map unchanged: phase=" + std::to_string(set.phase) + " reason=" + result.note.reason);
    return save(result);
  }
  telemetry.newest_revision.set(result.revision->number);
  options.log("map changed: revision=" + std::to_string(result.revision->number) +
              " phase=" + std::to_string(set.phase) + " added=" + std::to_string(result.note.added) +
              " freed=" + std::to_string(result.note.freed));
  MapRevision published = *result.revision;
  (void)revisions.try_send(std::move(published));
  save(result);
}

void Pipeline::State::save(const MapStep::Result& result) {
  if (out_store) keep(*out_store, result, map_step.method(), options.start.revision);
  if (options.out && result.revision) write_grid(*result.revision->map, *options.out / "map.yaml");
  if (store == nullptr) return;
  try {
    keep(*store, result, map_step.method());
  } catch (const std::exception& error) {
    options.log(std::string("revisions are kept no longer: ") + error.what());
    store = nullptr;
  }
}

// --- start and stop ---

Pipeline::Pipeline(const Settings& settings, Options options)
    : state_{std::make_unique<State>(settings, std::move(options))} {}

Pipeline::~Pipeline() { state_->end_threads(); }

void Pipeline::State::end_threads() {
  if (ended) return;
  ended = true;
  io.stop();
  io_thread->join();
  sensors.close();
  localization_thread->join();
  tracked_scans.close();
  awareness_thread->join();
  sets.close();
  map_thread->join();
  recorder.close();
  recorder_thread->join();
}

RunReport Pipeline::stop() {
  State& s = *state_;
  s.end_threads();
  RunReport report;
  const Telemetry& t = s.telemetry;
  report.scans = {.decoded = t.scans.value(),
                  .localized = t.localized.value(),
                  .dropped = t.dropped.value(),
                  .lost = t.scans_lost.value(),
                  .odometry = t.odometry.value(),
                  .odometry_lost = t.odometry_lost.value(),
                  .tracked_lost = t.tracked_lost.value(),
                  .sets_lost = t.sets_lost.value(),
                  .recording_lost = s.recorder.refused()};
  report.phases = t.phases_closed.value();
  report.changes = s.change_notes;
  report.time_lost_s = s.localization.time_lost_s();
  report.time_global_s = s.localization.time_global_s();
  report.recorded_s = s.localization.covered_s();
  report.cpu = {s.io_thread->cpu_s(), s.localization_thread->cpu_s(), s.awareness_thread->cpu_s(),
                s.map_thread->cpu_s(), s.recorder_thread->cpu_s()};
  report.cpu_total_s = process_cpu_s();
  report.wall_s = seconds(drivers::port::port_clock_now().time_since_epoch()) - s.wall_began_s;
  report.peak_resident_bytes = peak_resident_bytes();
  report.latency_of = "last byte of a scan to its pose";
  report.latency_p50_s = s.latency.quantile_s(0.5);
  report.latency_p99_s = s.latency.quantile_s(0.99);
  report.latency_max_s = s.latency.max_s();
  report.wire = s.io.counts();
  if (s.options.out) {
    LineFile file{*s.options.out / "report.json"};
    file.write(json_text(report));
    file.flush();
  }
  return report;
}

const Telemetry& Pipeline::telemetry() const { return state_->telemetry; }

double Pipeline::longest_work_s() const {
  return std::max({state_->io.silence_s(), state_->localization_work.busy_s(), state_->awareness_work.busy_s(),
                   state_->map_work.busy_s() / 10.0});
}

std::shared_ptr<const OccupancyGrid> Pipeline::newest_map() const { return state_->map_step.map(); }

}  // namespace deltamap::daemon
