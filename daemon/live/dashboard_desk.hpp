// SPDX-License-Identifier: Apache-2.0
// The live page, in the page thread: answers what a browser asks from telemetry and from what the stages have shown,
// and keeps viewers up to date. What it commands goes through the control desk; no stage waits for it.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "core/time.hpp"
#include "daemon/dashboard/server.hpp"
#include "daemon/live/live_board.hpp"
#include "daemon/live/live_figures.hpp"
#include "daemon/live/live_stream.hpp"
#include "daemon/live/page_commands.hpp"
#include "daemon/live/page_history.hpp"
#include "daemon/outputs/bays_board.hpp"
#include "daemon/outputs/things_board.hpp"
#include "daemon/settings/settings.hpp"
#include "daemon/site/site.hpp"
#include "daemon/steps/localization_step.hpp"
#include "daemon/telemetry/telemetry.hpp"

namespace deltamap::daemon {

/// What is known of goods, and what people have drawn.
struct GoodsBoards {
  const ThingsBoard& things;
  const BaysBoard& bays;
  const NewestBoard<Site>& site;
};

class DashboardDesk {
 public:
  /// Listens from now on. Throws std::runtime_error with one line that names the address, or the token's file.
  DashboardDesk(const Settings& settings, const StartMap& start, const Telemetry& telemetry, const GoodsBoards& goods,
                PageControl control = {});

  /// Where the stages show themselves.
  [[nodiscard]] LiveBoard& board() { return board_; }

  /// Once all have begun: what they cost is shown from now on.
  void watch(const WatchedStages& stages);

  /// The page thread's work, until stop().
  void run() { server_.run(); }
  void stop() { server_.stop(); }
  /// Where a browser finds the page: "http://127.0.0.1:8484/".
  [[nodiscard]] std::string url() const;

 private:
  [[nodiscard]] dashboard::Answer answer(const dashboard::Request& request);
  [[nodiscard]] dashboard::Answer newest_scan() const;
  [[nodiscard]] std::string status_json() const;
  [[nodiscard]] double since_start_s() const;
  /// Every period while there are viewers.
  void refresh();
  void refresh_scan(Timestamp now);
  void refresh_stored(Timestamp now);
  void watched(bool is_watched);

  Settings settings_;
  PageControl control_;
  std::uint64_t drivers_ = 0;  // who have come
  LiveBoard board_;
  PageHistory history_;
  const Telemetry& telemetry_;
  GoodsBoards goods_;
  Timestamp began_;
  LiveNews news_;
  LiveScan scan_;  // newest
  std::shared_ptr<const TransientObstacles> transients_;
  bool has_particles_ = false;   // that viewers know of
  mapping::StoredScans stored_;  // that viewers know of
  Timestamp scan_sent_, status_sent_, stored_sent_;
  dashboard::Server server_;  // last: its functions use the others
};

/// Null where the settings name no port, and, with a warning, where the page cannot be served: a daemon that cannot be
/// watched still does its work.
[[nodiscard]] std::unique_ptr<DashboardDesk> begun_dashboard(const Settings& settings, const StartMap& start,
                                                             const Telemetry& telemetry, const GoodsBoards& goods,
                                                             PageControl control,
                                                             const std::function<void(const std::string&)>& log,
                                                             const std::function<void(const std::string&)>& warn);

}  // namespace deltamap::daemon
