// SPDX-License-Identifier: Apache-2.0
#include "daemon/pipeline.hpp"

#include <algorithm>
#include <atomic>
#include <mutex>

#include "core/channel.hpp"
#include "core/files/file_lock.hpp"
#include "daemon/control/control_desk.hpp"
#include "daemon/incidents/incident_keeper.hpp"
#include "daemon/incidents/incident_list.hpp"
#include "daemon/live/dashboard_desk.hpp"
#include "daemon/live/page_commands.hpp"
#include "daemon/live/pose_stream.hpp"
#include "daemon/maps/newest_map.hpp"
#include "daemon/outputs/bay_note.hpp"
#include "daemon/outputs/thing_note.hpp"
#include "daemon/records/map_order.hpp"
#include "daemon/records/recorder.hpp"
#include "daemon/run_files.hpp"
#include "daemon/settings/memory_places.hpp"
#include "daemon/settings/start_error.hpp"
#include "daemon/site_drawing.hpp"
#include "daemon/stages/delta_stage.hpp"
#include "daemon/stages/localization_stage.hpp"
#include "daemon/stages/map_stage.hpp"
#include "daemon/steps/run_begin.hpp"
#include "daemon/system/used_memory.hpp"
#include "daemon/telemetry/stage.hpp"
#include "drivers/port/port_clock.hpp"

namespace deltamap::daemon {
namespace {

constexpr int kMapNiceness = 15;  // a map update never makes a scan wait, even on one processor
constexpr int kRecorderNiceness = 5;
constexpr int kControlNiceness = 5;
constexpr int kPageNiceness = 10;
constexpr double kPatience = 10.0;  // map and recorder may be silent so many times longer than other stages

}  // namespace

struct Pipeline::State {
  State(const Settings& given, Options wanted);

  // --- the flow: channel, thread, channel, thread ... (capacity: what is lost where it is full) ---

  Settings settings;
  LogTail log_tail;
  Options options;
  Telemetry telemetry;
  ThingsBoard things;      // map → control, page
  BaysBoard bays;          // delta → control, page, map (for the next run)
  NewestBoard<Site> site;  // whoever reloads or draws → page

  Channel<SensorMessage> sensors{128};    // io → localization: the newest message, journaled
  Channel<DeltaWork> tracked_scans{128};  // localization → delta: the newest scan is not looked at for changes,
                                          // journaled; of an order its sender is told
  Channel<MapWork> sets{2};           // delta → map: one more waits in the delta thread, the next is lost, journaled
  Channel<MapRevision> revisions{4};  // map → localization: a gap in numbers, which the localizer bridges
  Channel<std::shared_ptr<const TransientObstacles>> transients{8};  // delta → localization: offered again next scan
  Channel<control::Command> commands{16};       // control → localization: the newest command, and its sender is told
  Channel<SharedSite> sites{4};                 // whoever reloads or draws → localization → delta → map
  Channel<navigation::WanderParams> wander{4};  // whoever reloads → localization: refused, and who asked is told

  SharedSite site_at_start;  // in options.start, too

  // The locks come before everything that writes: where another daemon has the files, this one ends without harm.
  std::optional<FileLock> out_lock;               // of --out
  std::optional<FileLock> newest_lock;            // of map.newest
  std::unique_ptr<control::ControlDesk> control;  // requests of `deltamap ctl` → Command, status; may be null
  std::unique_ptr<DashboardDesk> page;            // what the stages show → browsers; may be null
  std::unique_ptr<PoseStream> poses;              // of each scan → programs on this machine; may be null
  std::unique_ptr<IncidentKeeper> incidents;      // what went wrong → minutes around it, on disk; may be null
  Recorder recorder;                              // bytes, decisions, lines → disk
  IoStage io;                                     // bytes → Odometry, Scan
  LocalizationStage localization;  // Odometry, Scan, MapRevision, transients, Command → TrackedScan, DriveCommand
  DeltaStage delta;                // TrackedScan → ScanSet, TransientObstacles
  MapStage map;                    // ScanSet, MapOrder → MapRevision

  void tell(const control::CommandOutcome& outcome) const {
    if (control) control->tell(outcome);
  }
  void tell(PoseStream::EventKind kind, std::string line) const {
    if (poses) poses->tell(kind, std::move(line));
  }
  LiveSettings::Outcome reload();
  control::CommandOutcome draw(const SiteEditOrder& order);
  bool set_log_level(LogLevel level);
  void begin_threads();
  void end_threads();

  control::ControlDesk::Wiring control_wiring();
  std::vector<std::string> notes_of_begin() const;
  IncidentKeeper::Options incident_options() const;
  Recorder::Options recorder_options() const;
  IoStage::Wiring io_wiring();
  LocalizationStage::Wiring localization_wiring();
  DeltaStage::Wiring delta_wiring();
  MapStage::Wiring map_wiring();

  std::mutex reloading;
  double wall_began_s = 0.0;
  std::atomic<bool> has_poses_ended{false};  // the pose stream has failed; the run goes on without it
  std::unique_ptr<Stage> io_thread, localization_thread, delta_thread, map_thread, recorder_thread, control_thread,
      page_thread, poses_thread;
  bool ended = false;
};

Pipeline::State::State(const Settings& given, Options wanted)
    : settings{given},
      options{with_warnings(std::move(wanted), log_tail)},
      site_at_start{begun_site(options.start, settings, options.warn)},
      out_lock{options.out ? or_start_error([&] { return lock_of_folder(*options.out); }) : std::nullopt},
      newest_lock{newest_map_lock(settings.map)},
      control{control::begun_control_desk(settings, control_wiring(), options.warn)},
      page{begun_dashboard(settings, options.start, telemetry, {things, bays, site}, page_control(control.get(), io),
                           options.log, options.warn)},
      poses{begun_pose_stream(settings, telemetry, options.warn)},
      incidents{begun_incident_keeper(incident_options(), telemetry, log_tail, {options.log, options.warn})},
      recorder{recorder_options(),
               telemetry,
               {.log = options.log,
                .saved = [this](const auto& outcome) { tell(outcome); },
                .warn = options.warn,
                .draw = [this](const SiteEditOrder& order) { return draw(order); }}},
      io{settings, io_wiring()},
      localization{settings, options.start, options.first_map, localization_wiring()},
      delta{settings, options.start, delta_wiring()},
      map{settings, options.start, options.first_map, options.out, std::move(options.store), map_wiring()} {
  site.set(site_at_start);
  telemetry.log_level.set(static_cast<std::uint8_t>(LogLevel::kInfo));
  telemetry.newest_revision.set(options.start.revision);
  telemetry.estimate.revision.set(options.start.revision);
  wall_began_s = seconds(drivers::port::port_clock_now().time_since_epoch());
  begin_threads();
}

// --- what joins the parts: in the order of the members, each names what stands before it, or what runs later ---

control::ControlDesk::Wiring Pipeline::State::control_wiring() {
  return {.map = options.start.map->geometry(),
          .commands = commands,
          .telemetry = telemetry,
          .let_drive = [this](bool may_drive, std::uint64_t ticket) { io.let_drive(may_drive, ticket); },
          .log = options.log,
          .reload = [this] { return reload(); },
          .record =
              [this](bool goes_on, std::uint64_t ticket) {
                return recorder.from_control().try_send(RecordOrder{goes_on, ticket});
              },
          .mark =
              [this](std::string words, std::uint64_t ticket) {
                return recorder.from_control().try_send(
                    std::make_unique<const MarkOrder>(MarkOrder{std::move(words), ticket}));
              },
          .draw =
              [this](SiteEdit edit, std::uint64_t ticket) {
                return recorder.from_control().try_send(
                    std::make_unique<const SiteEditOrder>(SiteEditOrder{std::move(edit), ticket}));
              },
          .incidents = [this] { return incidents_reply(settings.incidents); },
          .set_log_level = [this](LogLevel level) { return set_log_level(level); },
          .things = [this] { return json_of(*things.newest()); },
          .bays = [this] { return json_of(*bays.newest(), *things.newest(), drivers::port::port_clock_now()); },
          .patience_s = options.control_patience_s};
}

std::vector<std::string> Pipeline::State::notes_of_begin() const {
  return first_notes(settings, grid_hash(*options.start.map), {options.first_map, options.memory, options.start});
}

IncidentKeeper::Options Pipeline::State::incident_options() const {
  if (settings.incidents.folder.empty()) return {};
  return {.settings = settings,
          .first_notes = notes_of_begin(),
          .first_map = options.first_map,
          .map = options.start.map,
          .revision = options.start.revision,
          .began = drivers::port::port_clock_now()};
}

Recorder::Options Pipeline::State::recorder_options() const {
  return {.recording = settings.recording.file,
          .bauds = {settings.robot.session.baud, settings.laser.session.baud},
          .began = drivers::port::port_clock_now(),
          .first_notes = settings.recording.file.empty() ? std::vector<std::string>{} : notes_of_begin(),
          .max_gigabytes = settings.recording.max_gigabytes,
          .ring = settings.recording.is_ring()
                      ? std::optional{RingLimits{settings.recording.keep_gigabytes, settings.recording.keep_hours}}
                      : std::nullopt,
          .part_notes = [this](const Checkpoint& from) { return part_notes(settings, from); },
          .trajectory = in_folder(options.out, "trajectory.tum"),
          .localization = in_folder(options.out, "localization.csv"),
          .memory = memory_places(settings.map.store),
          .listener = incidents.get()};
}

IoStage::Wiring Pipeline::State::io_wiring() {
  return {.open = options.open,
          .mode = options.mode,
          .sensors = sensors,
          .recorder = recorder.from_io(),
          .telemetry = telemetry,
          .log = options.log,
          .warn = options.warn,
          .answer = [this](const control::CommandOutcome& outcome) { tell(outcome); }};
}

LocalizationStage::Wiring Pipeline::State::localization_wiring() {
  return {.sensors = sensors,
          .revisions = revisions,
          .transients = transients,
          .commands = commands,
          .wander = wander,
          .sites = sites,
          .tracked_scans = tracked_scans,
          .recorder = recorder.from_localization(),
          .telemetry = telemetry,
          .drive = [this](const PilotWord& word) { io.post(word); },
          .show =
              [this](const TrackedScan& tracked, const LocalizationRow& row, double latency_s,
                     const localization::particles::ParticleSet* particles) {
                if (page) page->board().show(tracked, row, latency_s, particles);
                if (poses) poses->show(row, latency_s);
              },
          .answer = [this](const control::CommandOutcome& outcome) { tell(outcome); }};
}

DeltaStage::Wiring Pipeline::State::delta_wiring() {
  return {.work = tracked_scans,
          .sets = sets,
          .transients = transients,
          .recorder = recorder.from_awareness(),
          .telemetry = telemetry,
          .log = options.log,
          .warn = options.warn,
          .show = [this](const auto& newest) { return page && page->board().show(newest); },
          .shows_scans = [this] { return page && page->board().is_watched(); },
          .show_scans = [this](mapping::StoredScans stored) { page->board().show(std::move(stored)); },
          .bays = bays,
          .remembered = remembered_bays(memory_places(settings.map.store).bays_seen, options.first_map,
                                        drivers::port::port_clock_now())};
}

MapStage::Wiring Pipeline::State::map_wiring() {
  return {.work = sets,
          .revisions = revisions,
          .recorder = recorder.from_map(),
          .telemetry = telemetry,
          .log = options.log,
          .warn = options.warn,
          .show =
              [this](const MapRevision* revision, const ChangeNote& note) {
                if (page) page->board().show(revision, note);
              },
          .answer = [this](const control::CommandOutcome& outcome) { tell(outcome); },
          .things = things,
          .bays = bays,
          .tell_thing = [this](std::string line) { tell(PoseStream::EventKind::kThing, std::move(line)); },
          .tell_bay = [this](std::string line) { tell(PoseStream::EventKind::kBay, std::move(line)); }};
}

// --- the threads ---

/// Receivers start before their senders.
void Pipeline::State::begin_threads() {
  const auto begun = [](const char* name, int niceness, auto body, auto failed) {
    return std::make_unique<Stage>(Stage::Options{name, niceness}, std::move(body), std::move(failed));
  };
  recorder_thread = begun(
      "recorder", kRecorderNiceness, [this] { recorder.run(); }, options.failed);
  map_thread = begun(
      "map", kMapNiceness, [this] { map.run(delta.waiting()); }, options.failed);
  delta_thread = begun(
      "delta", 0, [this] { delta.run(); }, options.failed);
  localization_thread = begun(
      "localization", 0, [this] { localization.run(); }, options.failed);
  io_thread = begun(
      "io", 0, [this] { io.run(); }, options.failed);
  if (control)
    control_thread = begun(
        "control", kControlNiceness, [this] { control->run(); }, options.failed);
  if (page) {
    const auto without_page = [this](const std::string& why) { options.warn("no live page any more: " + why); };
    page_thread = begun(
        "page", kPageNiceness, [this] { page->run(); }, without_page);
    page->watch({io_thread.get(), localization_thread.get(), delta_thread.get(), map_thread.get(),
                 recorder_thread.get(), page_thread.get()});
  }
  if (poses) {
    const auto without_poses = [this](const std::string& why) {
      has_poses_ended = true;
      options.warn("no stream of poses any more: " + why);
    };
    poses_thread = begun(
        "poses", 0, [this] { poses->run(); }, without_poses);
  }
}

LiveSettings::Outcome Pipeline::State::reload() {
  if (options.live == nullptr) return {false, {"the settings of this run came from no file"}};
  const std::scoped_lock one_after_another{reloading};
  LiveSettings::Outcome outcome = options.live->reload([this](const Settings& wanted) {
    if (!wander.try_send(navigation::WanderParams{wanted.navigation.wander})) return false;
    io.set_safety(wanted.navigation.safety);
    return true;
  });
  if (outcome.done) reload_site(settings, options.start.map->geometry(), {telemetry, sites, site}, outcome);
  for (const std::string& line : outcome.lines) (outcome.done ? options.log : options.warn)("reload: " + line);
  return outcome;
}

control::CommandOutcome Pipeline::State::draw(const SiteEditOrder& order) {
  const std::scoped_lock one_after_another{reloading};
  return draw_on_site(settings, options.start.map->geometry(), order, {telemetry, sites, site});
}

bool Pipeline::State::set_log_level(LogLevel level) {
  if (!options.set_log_level) return false;
  options.set_log_level(level);
  telemetry.log_level.set(static_cast<std::uint8_t>(level));
  return true;
}

LiveSettings::Outcome Pipeline::reload() { return state_->reload(); }

// --- start and stop ---

Pipeline::Pipeline(const Settings& settings, Options options)
    : state_{std::make_unique<State>(settings, std::move(options))} {}

Pipeline::~Pipeline() { state_->end_threads(); }

void Pipeline::State::end_threads() {
  if (ended) return;
  ended = true;
  io.stop();  // first: the robot stands, however long the other stages take to end
  io_thread->join();
  if (page) {
    page->stop();
    page_thread->join();
  }
  if (control) {
    control->stop();
    control_thread->join();
  }
  sensors.close();
  localization_thread->join();
  if (poses) {
    poses->stop();
    poses_thread->join();
  }
  tracked_scans.close();
  delta_thread->join();
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
  report.scans = counts_of(t);
  report.scans.recording_lost = s.recorder.refused();
  report.phases = t.phases_closed.value();
  report.changes = s.map.changes();
  add_to(report, s.localization.step());
  report.gate_times = s.delta.awareness().gate_times;
  report.cpu = {s.io_thread->cpu_s(), s.localization_thread->cpu_s(), s.delta_thread->cpu_s(), s.map_thread->cpu_s(),
                s.recorder_thread->cpu_s()};
  report.cpu_total_s = process_cpu_s();
  report.wall_s = seconds(drivers::port::port_clock_now().time_since_epoch()) - s.wall_began_s;
  report.peak_resident_bytes = peak_resident_bytes();
  report.latency_of = "last byte of a scan to its pose";
  report.latency = s.localization.latency();
  report.wire = s.io.counts();
  if (s.options.out) write_report(s.options, s.settings, report);
  return report;
}

const Telemetry& Pipeline::telemetry() const { return state_->telemetry; }

Pipeline::Silence Pipeline::longest_silence() const {
  State& s = *state_;
  return std::max({Silence{"io", s.io.silence_s()}, Silence{"localization", s.localization.pulse().silence_s()},
                   Silence{"delta", s.delta.pulse().silence_s()}, Silence{"map", s.map.pulse().silence_s() / kPatience},
                   Silence{"recorder", s.recorder.pulse().silence_s() / kPatience},
                   Silence{"control", s.control ? s.control->silence_s() : 0.0},
                   Silence{"poses", s.poses && !s.has_poses_ended ? s.poses->silence_s() : 0.0}},
                  [](const Silence& one, const Silence& other) { return one.silence_s < other.silence_s; });
}

std::shared_ptr<const OccupancyGrid> Pipeline::newest_map() const { return state_->map.map(); }

}  // namespace deltamap::daemon
