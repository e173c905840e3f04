// SPDX-License-Identifier: Apache-2.0
// Writes each change of a bay's state into bays.jsonl of --out and NAME.bays.jsonl beside the store, which both begin
// anew at a start. Map thread.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

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
  };
  BaysKeeper(const Options& options, OutputBoard& board, const RetryingOutput::Warn& warn, Timestamp now);

  /// `things`: that stand there now.
  void take(const mapping::bays::BayEvent& event, const std::vector<mapping::things::Thing>& things, Timestamp now);
  void retry(Timestamp now);
  /// The last attempt.
  void close(Timestamp now);

 private:
  std::optional<LiveLines> out_;
  std::optional<LiveLines> kept_;
};

}  // namespace deltamap::daemon
