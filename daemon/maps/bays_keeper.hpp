// SPDX-License-Identifier: Apache-2.0
// Writes each change of a bay's state into bays.jsonl of --out and NAME.bays.jsonl beside the store, which both begin
// anew at a start; and what is known of all bays into a file that the next run reads. Map thread.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "daemon/outputs/bays_board.hpp"
#include "daemon/outputs/line_file.hpp"
#include "daemon/telemetry/output_board.hpp"
#include "mapping/bays/bays.hpp"
#include "mapping/things/thing.hpp"

namespace deltamap::daemon {

class BaysKeeper {
 public:
  struct Options {
    std::optional<std::filesystem::path> out{};  ///< an existing folder; nothing: no file there
    std::filesystem::path kept{};                ///< beside the store; empty: no file there
    std::filesystem::path seen{};                ///< of what is known; empty: no file there
    std::uint64_t first_map = 0;                 ///< grid_hash() of M_0
  };
  BaysKeeper(const Options& options, OutputBoard& board, const RetryingOutput::Warn& warn, Timestamp now);

  /// `things`: that stand there now.
  void take(const mapping::bays::BayEvent& event, const std::vector<mapping::things::Thing>& things, Timestamp now);
  void retry(Timestamp now);
  /// What is known now: written a moment after each change, and once a minute.
  void keep(const BayList& list, Timestamp now);
  /// The last attempt.
  void close(const BayList& list, Timestamp now);

 private:
  std::optional<LiveLines> out_;
  std::optional<LiveLines> kept_;
  std::filesystem::path seen_;
  std::uint64_t first_map_;
  std::optional<RetryingOutput> seen_output_;
  std::optional<Timestamp> seen_written_{};  // nothing: what is known now must be written
};

}  // namespace deltamap::daemon
