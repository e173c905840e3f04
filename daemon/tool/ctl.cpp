// SPDX-License-Identifier: Apache-2.0
// `deltamap ctl`: asks the running daemon how it is, and tells it what to do.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "daemon/control/client.hpp"
#include "daemon/control/request.hpp"
#include "daemon/tool/status_table.hpp"
#include "daemon/tool/subcommands.hpp"

namespace deltamap::daemon::tool {
namespace {

using control::Request;
using Kind = Request::Kind;
using Json = nlohmann::ordered_json;


struct CtlOptions {
  std::string socket = "/run/deltamap/ctl.sock";
  std::string pose;
  std::string mode;
  std::uint32_t revision = 0;
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
  const std::string line = control::exchange(options.socket, control::line_of(request));
  const Json reply = Json::parse(line, nullptr, false);
  if (!reply.is_object() || !reply.contains("ok")) throw std::runtime_error(options.socket + ": no daemon of ours");
  if (options.as_json) std::cout << line << '\n';
  if (!reply["ok"].get<bool>()) throw std::runtime_error(reply.value("error", "the daemon could not"));
  if (options.as_json) return;
  if (request.kind == Kind::kStatus)
    std::cout << status_table(line);
  else
    std::cout << reply.value("message", "done") << '\n';
}

void add_plain(CLI::App& ctl, const std::shared_ptr<CtlOptions>& options, const char* name, Kind kind,
               const char* meaning) {
  ctl.add_subcommand(name, meaning)->callback([options, kind] { ask(*options, Request{kind, {}}); });
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

}  // namespace

void add_ctl(CLI::App& app) {
  auto options = std::make_shared<CtlOptions>();
  CLI::App& ctl = *app.add_subcommand("ctl", "talk to the running daemon")->require_subcommand(1)->fallthrough();
  ctl.add_option("--socket", options->socket, "the daemon's control.socket (default: /run/deltamap/ctl.sock)");
  ctl.add_flag("--json", options->as_json, "print the daemon's reply");
  add_plain(ctl, options, "status", Kind::kStatus, "how it is");
  add_plain(ctl, options, "pause", Kind::kPause, "the map stays as it is; the localizer goes on");
  add_plain(ctl, options, "resume", Kind::kResume, "the map follows the world again");
  add_plain(ctl, options, "save", Kind::kSave, "write map and pose now");
  add_plain(ctl, options, "reload", Kind::kReload, "read the settings file again: take what can change, name the rest");
  add_map_order(ctl, options, "undo", Kind::kUndo, "take revision K back and keep what came later");
  add_map_order(ctl, options, "rollback", Kind::kRollBack, "make the map what revision K was; nothing is lost");
  CLI::App& relocalize = *ctl.add_subcommand("relocalize", "say where the robot is");
  relocalize.add_option("pose", options->pose, "X,Y,DEG of the robot in the map, good to 0.2 m and 10 degrees")
      ->required();
  relocalize.callback([options] { ask(*options, Request{Kind::kRelocalize, pose_of(options->pose)}); });
  CLI::App& drive = *ctl.add_subcommand("drive", "let the robot drive, or make it stand");
  drive.add_option("mode", options->mode, "off or wander")->required()->check(CLI::IsMember({"off", "wander"}));
  drive.callback([options] {
    ask(*options, Request{options->mode == "off" ? Kind::kDriveOff : Kind::kDriveWander, {}});
  });
}

}  // namespace deltamap::daemon::tool
