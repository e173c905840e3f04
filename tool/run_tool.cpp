// SPDX-License-Identifier: Apache-2.0
#include "tool/run_tool.hpp"

#include <CLI/CLI.hpp>

#include "daemon/telemetry/version.hpp"
#include "tool/command_line.hpp"
#include "tool/subcommands.hpp"

namespace deltamap::tool {

int run_tool(int argc, const char* const* argv) {
  CLI::App app{"deltamap: keeps a robot localized in a map that follows the world", "deltamap"};
  app.set_version_flag("--version", "deltamap " + daemon::version_text());
  app.require_subcommand(1);
  add_bays(app);
  add_compare(app);
  add_ctl(app);
  add_score(app);
  add_sim(app);
  CLI::App& map = *app.add_subcommand("map", "make, compare, merge and look at maps")->require_subcommand(1);
  add_map_build(map);
  add_map_compare(map);
  add_map_film(map);
  add_map_from_poses(map);
  add_map_history(map);
  add_map_merge(map);
  add_map_picture(map);
  add_map_quality(map);
  CLI::App& import = *app.add_subcommand("import", "other people's logs as recordings")->require_subcommand(1);
  add_import_carmen(import);
  add_import_messages(import);
  CLI::App& calibrate =
      *app.add_subcommand("calibrate", "fit the robot's parameters to a recording")->require_subcommand(1);
  add_calibrate_motion(calibrate);
  add_decode(app);
  add_export(app);
  add_incident(app);
  add_info(app);
  add_replay(app);
  add_sweep(app);
  add_things(app);
  add_view(app);
  return answer_of(app, argc, argv);
}

}  // namespace deltamap::tool
