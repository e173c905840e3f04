// SPDX-License-Identifier: Apache-2.0
#include "tool/run_tool.hpp"

#include <CLI/CLI.hpp>
#include <exception>
#include <iostream>
#include <stdexcept>
#include <string>
#include <string_view>

#include "daemon/control/request.hpp"
#include "daemon/settings/settings.hpp"
#include "daemon/telemetry/version.hpp"
#include "tool/subcommands.hpp"

namespace deltamap::tool {
namespace {

/// Whoever reads the replies of the daemon as JSON reads what has kept them away the same way.
void tell_in_json(int argc, const char* const* argv, const std::string& error) {
  const auto is = [&](int at, std::string_view word) { return argv[at] == word; };
  bool is_asked = false;
  for (int at = 2; at < argc && is(1, "ctl"); ++at) is_asked = is_asked || is(at, "--json");
  if (is_asked) std::cout << daemon::control::error_line(error) << std::endl;
}

}  // namespace

int run_tool(int argc, const char* const* argv) {
  CLI::App app{"deltamap: keeps a robot localized in a map that follows the world", "deltamap"};
  app.set_version_flag("--version", "deltamap " + daemon::version_text());
  app.require_subcommand(1);
  add_ctl(app);
  add_experiment(app);
  add_score(app);
  add_sim(app);
  CLI::App& map = *app.add_subcommand("map", "make, compare, merge and look at maps")->require_subcommand(1);
  add_map_compare(map);
  add_map_film(map);
  add_map_from_poses(map);
  add_map_history(map);
  add_map_merge(map);
  add_map_picture(map);
  CLI::App& import = *app.add_subcommand("import", "other people's logs as recordings")->require_subcommand(1);
  add_import_carmen(import);
  CLI::App& calibrate =
      *app.add_subcommand("calibrate", "fit the robot's parameters to a recording")->require_subcommand(1);
  add_calibrate_motion(calibrate);
  add_decode(app);
  add_replay(app);
  add_view(app);
  try {
    app.parse(argc, argv);
    if (!std::cout.flush()) throw std::runtime_error("standard output: cannot be written");
  } catch (const CLI::ParseError& error) {
    const int code = app.exit(error) == 0 ? 0 : 2;
    if (code != 0) tell_in_json(argc, argv, error.what());
    return code;
  } catch (const daemon::SettingsError& error) {
    for (const std::string& problem : error.lines()) std::cerr << "deltamap: " << problem << '\n';
    return 2;
  } catch (const std::exception& error) {
    tell_in_json(argc, argv, error.what());
    std::cerr << "deltamap: " << error.what() << '\n';
    return 1;
  }
  return 0;
}

}  // namespace deltamap::tool
