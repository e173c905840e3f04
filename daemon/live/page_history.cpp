// SPDX-License-Identifier: Apache-2.0
#include "daemon/live/page_history.hpp"

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "core/grid/grid_patch.hpp"
#include "daemon/dashboard/cells.hpp"
#include "daemon/dashboard/wire.hpp"

namespace deltamap::daemon {
namespace {

using dashboard::Answer;

constexpr std::string_view kPrefix = "/api/revision/";
constexpr std::size_t kMostChanges = 100'000;  // cells in an answer

Answer missing(const std::string& why) { return {.status = 404, .body = why + "\n"}; }

/// The boxes of known cells, as /live sends them, each after the number of its bytes.
Answer cells_of(const OccupancyGrid& grid, std::uint32_t number) {
  std::string bytes;
  for (const CellBox& piece : dashboard::pieces_of(known_box(grid))) {
    const std::string message = dashboard::cells_message(grid, piece, number);
    dashboard::append_number(bytes, static_cast<std::uint32_t>(message.size()));
    bytes += message;
  }
  return {.type = "application/octet-stream", .body = std::move(bytes)};
}

Answer changes_of(const std::vector<CellChange>& changes, std::uint32_t number) {
  if (changes.size() > kMostChanges) {
    return {.status = 413, .body = "too many cells for an answer: " + std::to_string(changes.size()) + "\n"};
  }
  nlohmann::ordered_json json{{"revision", number}, {"cells", nlohmann::ordered_json::array()}};
  for (const CellChange& change : changes) {
    json["cells"].push_back(
        {change.cell.column, change.cell.row, static_cast<int>(change.before), static_cast<int>(change.after)});
  }
  return {.type = "application/json", .body = json.dump() + "\n"};
}

}  // namespace

std::optional<RevisionPath> revision_path(std::string_view path) {
  if (!path.starts_with(kPrefix)) return std::nullopt;
  path.remove_prefix(kPrefix.size());
  RevisionPath wanted;
  const auto [end, error] = std::from_chars(path.data(), path.data() + path.size(), wanted.number);
  if (error != std::errc{} || end == path.data() + path.size() || *end != '/') return std::nullopt;
  wanted.part = path.substr(static_cast<std::size_t>(end - path.data()) + 1);
  return wanted;
}

Answer PageHistory::answer(std::string_view path) {
  const auto wanted = revision_path(path);
  if (!wanted || (wanted->part != "cells" && wanted->part != "changes")) {
    return missing("there is /api/revision/K/cells and /api/revision/K/changes");
  }
  if (file_.empty()) return missing("no map store: 'map.store' is empty, so nothing is kept of earlier revisions");
  try {
    return answer_from_store(*wanted);
  } catch (const std::exception& error) {
    store_.reset();  // the next request opens the store anew
    return missing(error.what());
  }
}

Answer PageHistory::answer_from_store(const RevisionPath& wanted) {
  if (store_)
    store_->catch_up();
  else
    store_.emplace(file_);
  if (wanted.part == "cells") return cells_of(store_->grid(wanted.number), wanted.number);
  return changes_of(store_->changes(wanted.number), wanted.number);
}

}  // namespace deltamap::daemon
