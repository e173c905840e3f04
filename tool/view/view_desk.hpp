// SPDX-License-Identifier: Apache-2.0
// The page for a run that is over, or is being replayed: the live page's server, files and messages, fed from what was
// kept. It listens on loopback and takes no commands.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "daemon/dashboard/server.hpp"
#include "daemon/live/live_board.hpp"
#include "daemon/live/live_stream.hpp"
#include "daemon/live/page_history.hpp"
#include "daemon/replay/replay_run.hpp"
#include "daemon/settings/settings.hpp"
#include "tool/view/moment_file.hpp"
#include "tool/view/run_events.hpp"
#include "tool/view/run_things.hpp"

namespace deltamap::tool {

struct ViewedRun {
  std::string kind;    ///< "recording", "folder", "map"
  std::string name{};  ///< of the file or folder, for people
  daemon::Settings settings{};
  std::shared_ptr<const OccupancyGrid> map{};
  std::uint32_t revision = 0;        ///< of `map`
  std::uint32_t first_revision = 0;  ///< that the run began on: the store counts from it
  std::filesystem::path store{};     ///< of the run's revisions; may come to be later
  std::filesystem::path things{};    ///< its things.jsonl; may come to be later
};

class ViewDesk {
 public:
  /// Listens from now on; port 0: any that is free. Throws std::runtime_error with one line that names address and
  /// port.
  ViewDesk(ViewedRun run, std::uint16_t port);

  // The thread that reads the run. All throw std::system_error where there is no room.
  void show(const daemon::ReplayedScan& scan);
  /// Of a scan no more than its line of the log.
  void show(const daemon::LocalizationRow& row);
  void show(const MapRevision* revision, const daemon::ChangeNote& note);
  /// What a person may jump to besides what is shown.
  [[nodiscard]] RunEvents& events() { return events_; }
  /// How much has been read, 0 to 1.
  void tell_progress(double done);
  /// All has been read; `note`: one line of what is wrong with it, or empty.
  void tell_complete(const std::string& note);

  /// The page thread's work, until stop().
  void run() { server_.run(); }
  void stop() { server_.stop(); }
  /// "http://127.0.0.1:8484/"
  [[nodiscard]] std::string url() const { return "http://" + server_.place() + "/"; }

 private:
  void keep_lasting(Timestamp now, const mapping::StoreScan& awareness);
  [[nodiscard]] daemon::dashboard::Answer answer(const daemon::dashboard::Request& request);
  [[nodiscard]] daemon::dashboard::Answer moment(const std::string& query) const;
  [[nodiscard]] daemon::dashboard::Answer things(const std::string& query);
  [[nodiscard]] daemon::dashboard::Answer revision(const std::string& path);
  [[nodiscard]] std::string run_message() const;
  void refresh();

  ViewedRun run_;
  daemon::LiveBoard board_;
  daemon::PageHistory history_;
  MomentFile moments_;
  RunEvents events_;
  RunThings things_;
  std::shared_ptr<const TransientObstacles> transients_;  // that the newest moment shows, as the next
  mapping::StoredScans stored_;
  std::optional<Timestamp> lasting_kept_;
  daemon::LiveNews news_;
  Timestamp told_;
  mutable std::mutex mutex_;  // of what the two threads share below
  double done_ = 0.0;
  bool is_complete_ = false;
  std::string note_;
  daemon::dashboard::Server server_;  // last: its functions use the others
};

}  // namespace deltamap::tool
