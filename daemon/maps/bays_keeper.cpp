// SPDX-License-Identifier: Apache-2.0
#include "daemon/maps/bays_keeper.hpp"

#include "daemon/outputs/bay_note.hpp"

namespace deltamap::daemon {

BaysKeeper::BaysKeeper(const Options& options, OutputBoard& board, const RetryingOutput::Warn& warn, Timestamp now) {
  if (options.out) {
    const auto file = *options.out / "bays.jsonl";
    out_.emplace(file, RetryingOutput{"bays", file, board, warn});
  }
  if (!options.kept.empty()) kept_.emplace(options.kept, RetryingOutput{"kept bays", options.kept, board, warn});
  retry(now);
}

void BaysKeeper::take(const mapping::bays::BayEvent& event, const std::vector<mapping::things::Thing>& things,
                      Timestamp now) {
  const std::string line = json_line(event, things);
  if (out_) out_->write(line, now);
  if (kept_) kept_->write(line, now);
  retry(now);
}

void BaysKeeper::retry(Timestamp now) {
  if (out_) out_->flush(now);
  if (kept_) kept_->flush(now);
}

void BaysKeeper::close(Timestamp now) {
  if (out_) out_->close(now);
  if (kept_) kept_->close(now);
}

}  // namespace deltamap::daemon
