// SPDX-License-Identifier: Apache-2.0
// `deltamap map compare A B`: how much two maps agree: Eq. 11, contour F1, cells. Other geometries are read at A's
// cells.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "mapping/registration/acceptance.hpp"
#include "mapping/registration/contour_score.hpp"
#include "tool/subcommands.hpp"
#include "tool/told_grid.hpp"

namespace deltamap::tool {
namespace {

void print_comparison(const mapping::registration::Acceptance& cells,
                      const mapping::registration::ContourScore& contour, bool as_json) {
  if (as_json) {
    const nlohmann::ordered_json json = {{"acceptance", cells.value()},
                                         {"agreeing_cells", cells.agreeing},
                                         {"disagreeing_cells", cells.disagreeing},
                                         {"contour_f1", contour.f1()},
                                         {"contour_precision", contour.precision()},
                                         {"contour_recall", contour.recall()}};
    std::cout << json.dump() << '\n';
    return;
  }
  std::printf("acceptance (Eq. 11)  %.5f\nagreeing cells       %zu\ndisagreeing cells    %zu\n", cells.value(),
              cells.agreeing, cells.disagreeing);
  std::printf("contour F1           %.4f  (precision %.4f, recall %.4f)\n", contour.f1(), contour.precision(),
              contour.recall());
}

}  // namespace

void add_map_compare(CLI::App& map) {
  struct Options {
    std::string one;
    std::string other;
    bool as_json = false;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command = map.add_subcommand("compare", "how much two maps agree: acceptance (Eq. 11), contour F1, cells");
  command->add_option("A", options->one, "map_server YAML, the reference")->required();
  command->add_option("B", options->other, "map_server YAML, read at A's cells")->required();
  command->add_flag("--json", options->as_json, "one JSON object");
  command->callback([options] {
    const OccupancyGrid one = told_grid(options->one);
    const OccupancyGrid other = told_grid(options->other);
    print_comparison(mapping::registration::acceptance(one, other), mapping::registration::contour_score(one, other),
                     options->as_json);
  });
}

}  // namespace deltamap::tool
