// SPDX-License-Identifier: Apache-2.0
// Pieces of work that know nothing of each other, several at once.
#pragma once

#include <cstddef>
#include <functional>

namespace deltamap {

/// Does work(0) to work(pieces - 1), each once, begun in this order, on `jobs` threads. `done` is told after each which
/// it was; one call at a time. The first exception of a piece, or of `done`, is thrown on once all that had begun have
/// ended; no more are begun then. jobs > 0.
void work_through(std::size_t pieces, int jobs, const std::function<void(std::size_t)>& work,
                  const std::function<void(std::size_t)>& done);

}  // namespace deltamap
