// SPDX-License-Identifier: Apache-2.0
// A bay or zone that a person draws while the daemon runs: into its file, which is written whole or not at all, and
// then in force as by a reload.
#pragma once

#include "daemon/control/command.hpp"
#include "daemon/records/recorder.hpp"
#include "daemon/site_reload.hpp"

namespace deltamap::daemon {

/// Waits for the disk. Refused, and nothing has changed: where no file is named, what is wanted cannot be, its sender
/// has seen another list, or the file holds another one than is in force. A file that a rewrite would lose something of
/// (comments, layout) is kept beside it. Never by two threads at once, nor beside reload_site().
[[nodiscard]] control::CommandOutcome draw_on_site(const Settings& settings, const GridGeometry& map,
                                                   const SiteEditOrder& order, const SiteInForce& in_force);

}  // namespace deltamap::daemon
