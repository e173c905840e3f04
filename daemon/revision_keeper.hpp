// SPDX-License-Identifier: Apache-2.0
// Puts what became of each Δ-phase into a map store: accepted revisions and refusals. Map thread.
#pragma once

#include <string_view>

#include "daemon/map_step.hpp"
#include "mapping/map_store.hpp"

namespace deltamap::daemon {

/// `numbers_before` is what the store does not count: the revision that the run started on, where the store began with
/// it. Throws std::runtime_error naming the file.
inline void keep(mapping::MapStore& store, const MapStep::Result& result, std::string_view method,
                 std::uint32_t numbers_before = 0) {
  const ChangeNote& note = result.note;
  const std::string cause = result.revision && note.reason.empty() ? std::string(method) : note.reason;
  const mapping::RevisionNote kept{note.phase, note.acceptance, cause, note.covariance};
  if (!result.revision) return store.append_refusal(note.time, kept);
  MapRevision revision = *result.revision;
  revision.number -= numbers_before;
  store.append(revision, kept);
}

}  // namespace deltamap::daemon
