// SPDX-License-Identifier: Apache-2.0
// /api/revision/K/…: M_0 … M_K as the map store has them, of this run and of those before it. Reads the store by a
// connection of its own, which keeps nobody from writing. Page thread.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>

#include "daemon/dashboard/request.hpp"
#include "mapping/store/map_store.hpp"

namespace deltamap::daemon {

/// What a path asks for: "/api/revision/12/cells".
struct RevisionPath {
  std::uint32_t number = 0;
  std::string_view part;
};
[[nodiscard]] std::optional<RevisionPath> revision_path(std::string_view path);

class PageHistory {
 public:
  /// Opened when it is first asked for. Empty: there is none.
  explicit PageHistory(std::filesystem::path store) : file_{std::move(store)} {}

  /// `cells`, `changes`. What cannot be answered is told in one line.
  [[nodiscard]] dashboard::Answer answer(std::string_view path);

 private:
  [[nodiscard]] dashboard::Answer answer_from_store(const RevisionPath& wanted);

  std::filesystem::path file_;
  std::optional<mapping::store::MapStore> store_;
};

}  // namespace deltamap::daemon
