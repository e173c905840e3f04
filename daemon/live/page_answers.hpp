// SPDX-License-Identifier: Apache-2.0
// Answers that the page of a running daemon and the page of a finished run share.
#pragma once

#include <string_view>

#include "daemon/dashboard/request.hpp"
#include "daemon/live/live_board.hpp"

namespace deltamap::daemon {

/// A file of the page: "index.html"; 404 where there is none.
[[nodiscard]] dashboard::Answer page_file(std::string_view name);

/// A map as "png", as map_server's "yaml", or as its "pgm". It is laid out whole, a byte a cell: 413 where it is too
/// large.
[[nodiscard]] dashboard::Answer map_answer(const LiveBoard::Map& map, std::string_view form);

}  // namespace deltamap::daemon
