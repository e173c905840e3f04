// SPDX-License-Identifier: Apache-2.0
#include "daemon/live/page_answers.hpp"

#include <string>

#include "core/files/grid_file.hpp"
#include "daemon/dashboard/page_files.hpp"
#include "daemon/maps/map_picture.hpp"

namespace deltamap::daemon {

using dashboard::Answer;

Answer page_file(std::string_view name) {
  for (const dashboard::PageFile& file : dashboard::page_files()) {
    if (file.name == name) return {.type = std::string(file.type), .body = std::string(file.content)};
  }
  return {.status = 404, .body = "there is no such page\n"};
}

Answer map_answer(const LiveBoard::Map& map, std::string_view form) {
  constexpr std::int64_t kMostCells = 4'000'000;  // larger ones would cost the memory that the robot needs
  const CellBox known = known_box(*map.grid);
  const CellBox drawn = form != "png" || known.empty() ? map.grid->box() : known;
  const std::int64_t cells = std::int64_t{drawn.width()} * drawn.height();
  if (form != "yaml" && cells > kMostCells) {
    return {.status = 413, .body = "the map is too large for a picture: " + std::to_string(cells) + " cells\n"};
  }
  Answer answer;
  answer.headers = {{"X-Deltamap-Revision", std::to_string(map.revision)}};
  if (form == "png") {
    answer.type = "image/png";
    answer.body = map_picture(*map.grid);
  } else if (form == "pgm") {
    answer.type = "image/x-portable-graymap";
    answer.body = pgm_of(*map.grid);
  } else {
    answer.type = "application/yaml";
    answer.body = yaml_of(*map.grid, "map.pgm");
  }
  return answer;
}

}  // namespace deltamap::daemon
