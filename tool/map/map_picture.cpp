// SPDX-License-Identifier: Apache-2.0
#include "daemon/maps/map_picture.hpp"

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "core/grid_file.hpp"
#include "tool/subcommands.hpp"

namespace deltamap::tool {

void add_map_picture(CLI::App& map) {
  struct Options {
    std::string map;
    std::string before;
    std::string png;
    int scale = 1;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command = map.add_subcommand("picture", "draw a map as a PNG; with --before, what has changed in colour");
  command->add_option("MAP", options->map, "map_server YAML")->required();
  command->add_option("PNG", options->png, "picture to write")->required();
  command->add_option("--before", options->before, "an earlier map of the same place");
  command->add_option("--scale", options->scale, "pixels a cell")->check(CLI::Range(1, 16));
  command->callback([options] {
    const OccupancyGrid after = read_grid(options->map);
    const OccupancyGrid before = options->before.empty() ? after : read_grid(options->before);
    daemon::write_map_picture(before, after, options->png, {.cell_pixels = options->scale});
  });
}

}  // namespace deltamap::tool
