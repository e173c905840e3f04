// SPDX-License-Identifier: Apache-2.0
// `deltamap ctl`: asks the running daemon how it is, and tells it what to do.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <cstdio>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "daemon/control/request.hpp"
#include "daemon/telemetry/log_level.hpp"
#include "tool/ctl/bays_table.hpp"
#include "tool/ctl/daemon_reply.hpp"
#include "tool/ctl/status_table.hpp"
#include "tool/ctl/status_watch.hpp"
#include "tool/ctl/things_table.hpp"
#include "tool/subcommands.hpp"

namespace deltamap::tool {
namespace {

using daemon::control::Request;
using Kind = Request::Kind;

constexpr double kShortestWatch_s = 0.1;
constexpr double kLongestWatch_s = 3600.0;

struct CtlOptions {
  std::string socket = "/run/deltamap/ctl.sock";
  std::string pose;
  std::string mode;
  std::string watch;  // seconds; empty: one
  std::string level;
  std::vector<std::string> words;
  std::uint32_t revision = 0;
  std::vector<std::string> undone;  // "7", or "thing" and "12"
  bool as_json = false;
};

/// "X,Y,DEG", and nothing after it.
Pose2 pose_of(const std::string& text) {
  Pose2 pose;
  double heading_deg = 0.0;
  int read = -1;
  const int found = std::sscanf(text.c_str(), "%lf,%lf,%lf%n", &pose.x, &pose.y, &heading_deg, &read);
  const bool is_pose = found == 3 && read == static_cast<int>(text.size()) && std::isfinite(pose.x) &&
                       std::isfinite(pose.y) && std::isfinite(heading_deg);
  if (!is_pose) throw CLI::ValidationError("relocalize", "needs X,Y,DEG, not '" + text + "'");
  pose.theta = wrapped_angle(radians(heading_deg));
  return pose;
}

void ask(const CtlOptions& options, const Request& request) {
  const DaemonReply reply = reply_to(request, options.socket);
  if (!reply.ok) throw std::runtime_error(reply.words);
  if (options.as_json)
    std::cout << reply.line << '\n';
  else if (request.kind == Kind::kStatus)
    std::cout << status_table(reply.line);
  else if (request.kind == Kind::kThings)
    std::cout << things_table(reply.line);
  else if (request.kind == Kind::kBays)
    std::cout << bays_table(reply.line);
  else
    std::cout << reply.words << '\n';
}

void add_plain(CLI::App& ctl, const std::shared_ptr<CtlOptions>& options, const char* name, Kind kind,
               const char* meaning) {
  ctl.add_subcommand(name, meaning)->callback([options, kind] { ask(*options, Request{kind, {}}); });
}

/// Seconds between two looks.
double watch_period_of(const std::string& text) {
  if (text.empty()) return 1.0;
  double period_s = 0.0;
  int read = -1;
  const int found = std::sscanf(text.c_str(), "%lf%n", &period_s, &read);
  const bool is_period = found == 1 && read == static_cast<int>(text.size()) && period_s >= kShortestWatch_s &&
                         period_s <= kLongestWatch_s;
  if (!is_period) throw CLI::ValidationError("--watch", "needs 0.1 to 3600 seconds, not '" + text + "'");
  return period_s;
}

void add_status_command(CLI::App& ctl, const std::shared_ptr<CtlOptions>& options) {
  CLI::App& status = *ctl.add_subcommand("status", "how it is");
  const CLI::Option* watch =
      status.add_option("--watch", options->watch, "a line a second, or each S seconds, until Ctrl-C")
          ->type_name("[S]")
          ->expected(0, 1);
  status.callback([options, watch] {
    if (watch->count() == 0) return ask(*options, Request{});
    watch_status({.socket = options->socket,
                  .period_s = watch_period_of(options->watch),
                  .as_json = options->as_json,
                  .on_terminal = ::isatty(STDOUT_FILENO) == 1},
                 std::cout, std::cerr);
  });
}

void add_log_level(CLI::App& ctl, const std::shared_ptr<CtlOptions>& options) {
  CLI::App& log_level = *ctl.add_subcommand("log-level", "what goes into the log from now on, until the next start");
  const std::vector<std::string> names(daemon::kLogLevelNames.begin(), daemon::kLogLevelNames.end());
  log_level.add_option("LEVEL", options->level, "trace, debug, info, warn or error")
      ->required()
      ->check(CLI::IsMember(names));
  log_level.callback([options] {
    Request request{Kind::kLogLevel, {}};
    request.log_level = daemon::log_level_of(options->level).value();
    ask(*options, request);
  });
}

void add_map_order(CLI::App& ctl, const std::shared_ptr<CtlOptions>& options, const char* name, Kind kind,
                   const char* meaning) {
  CLI::App& order = *ctl.add_subcommand(name, meaning);
  order.add_option("K", options->revision, "number of the revision (deltamap map history STORE list)")->required();
  order.callback([options, kind] {
    Request request{kind, {}};
    request.revision = options->revision;
    ask(*options, request);
  });
}

void add_mark(CLI::App& ctl, const std::shared_ptr<CtlOptions>& options) {
  CLI::App& mark = *ctl.add_subcommand("mark", "keep the minutes around this moment as an incident");
  mark.add_option("words", options->words, "what has happened, for whoever looks at it later");
  mark.callback([options] {
    Request request{Kind::kMark, {}};
    for (const std::string& word : options->words) request.words += (request.words.empty() ? "" : " ") + word;
    ask(*options, request);
  });
}

/// A number, and nothing after it.
std::uint32_t number_of(const std::string& text) {
  std::uint32_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size()) {
    throw CLI::ValidationError("undo", "needs a number, or 'thing' and a number, not '" + text + "'");
  }
  return number;
}

void add_undo(CLI::App& ctl, const std::shared_ptr<CtlOptions>& options) {
  CLI::App& order = *ctl.add_subcommand("undo", "take a revision or a thing back and keep what came later");
  order
      .add_option("K", options->undone,
                  "number of the revision (deltamap map history STORE list); or thing N (ctl things)")
      ->required()
      ->expected(1, 2);
  order.callback([options] {
    Request request{Kind::kUndo, {}};
    if (options->undone.size() == 1) {
      request.revision = number_of(options->undone[0]);
    } else {
      if (options->undone[0] != "thing") (void)number_of(options->undone[0] + " " + options->undone[1]);
      request.kind = Kind::kUndoThing;
      request.thing = number_of(options->undone[1]);
    }
    ask(*options, request);
  });
}

}  // namespace

void add_ctl(CLI::App& app) {
  auto options = std::make_shared<CtlOptions>();
  CLI::App& ctl = *app.add_subcommand("ctl", "talk to the running daemon")->require_subcommand(1)->fallthrough();
  ctl.add_option("--socket", options->socket, "the daemon's control.socket (default: /run/deltamap/ctl.sock)");
  ctl.add_flag("--json", options->as_json, "print the daemon's reply, or what has kept it away, as JSON");
  add_status_command(ctl, options);
  add_plain(ctl, options, "pause", Kind::kPause, "the map stays as it is; the localizer goes on");
  add_plain(ctl, options, "resume", Kind::kResume, "the map follows the world again");
  add_plain(ctl, options, "save", Kind::kSave, "write map and pose now");
  CLI::App& map = *ctl.add_subcommand("map", "map save: the same as save")->require_subcommand(1);
  add_plain(map, options, "save", Kind::kSave, "write map and pose now");
  add_plain(ctl, options, "reload", Kind::kReload, "read the settings file again: take what can change, name the rest");
  add_plain(ctl, options, "things", Kind::kThings, "what has come, gone and moved");
  add_plain(ctl, options, "bays", Kind::kBays, "what stands in the bays of the site");
  add_undo(ctl, options);
  add_map_order(ctl, options, "rollback", Kind::kRollBack, "make the map what revision K was; nothing is lost");
  add_log_level(ctl, options);
  add_mark(ctl, options);
  add_plain(ctl, options, "incidents", Kind::kIncidents, "which incidents are kept");
  CLI::App& record = *ctl.add_subcommand("record", "stop the recording of this run, or let it go on behind a gap");
  record.add_option("MODE", options->mode, "start or stop")->required()->check(CLI::IsMember({"start", "stop"}));
  record.callback([options] {
    ask(*options, Request{options->mode == "start" ? Kind::kRecordStart : Kind::kRecordStop, {}});
  });
  CLI::App& relocalize = *ctl.add_subcommand("relocalize", "say where the robot is");
  relocalize.add_option("pose", options->pose, "X,Y,DEG of the robot in the map, good to 0.2 m and 10 degrees")
      ->required();
  relocalize.callback([options] { ask(*options, Request{Kind::kRelocalize, pose_of(options->pose)}); });
  CLI::App& drive = *ctl.add_subcommand("drive", "let the robot drive, or make it stand");
  drive.add_option("MODE", options->mode, "off or wander")->required()->check(CLI::IsMember({"off", "wander"}));
  drive.callback([options] {
    ask(*options, Request{options->mode == "off" ? Kind::kDriveOff : Kind::kDriveWander, {}});
  });
}

}  // namespace deltamap::tool
