// SPDX-License-Identifier: Apache-2.0
#include "daemon/maps/bays_keeper.hpp"

#include "core/files/replace_file.hpp"
#include "daemon/maps/kept_bays.hpp"
#include "daemon/outputs/bay_note.hpp"

namespace deltamap::daemon {

namespace {

constexpr double kSeenPeriod_s = 60.0;  // so much older at most bays look after a crash

}  // namespace

BaysKeeper::BaysKeeper(const Options& options, OutputBoard& board, const RetryingOutput::Warn& warn, Timestamp now)
    : seen_{options.seen}, first_map_{options.first_map}, seen_written_{now} {
  if (options.out) {
    const auto file = *options.out / "bays.jsonl";
    out_.emplace(file, RetryingOutput{"bays", file, board, warn});
  }
  if (!options.kept.empty()) kept_.emplace(options.kept, RetryingOutput{"kept bays", options.kept, board, warn});
  if (!seen_.empty()) seen_output_.emplace("seen bays", seen_, board, warn);
  retry(now);
}

void BaysKeeper::take(const mapping::bays::BayEvent& event, const std::vector<mapping::things::Thing>& things,
                      Timestamp now) {
  const std::string line = json_line(event, things);
  if (out_) out_->write(line, now);
  if (kept_) kept_->write(line, now);
  seen_written_.reset();
  retry(now);
}

void BaysKeeper::keep(const BayList& list, Timestamp now) {
  if (!seen_output_ || (seen_written_ && seconds(now - *seen_written_) < kSeenPeriod_s)) return;
  const bool is_written = seen_output_->attempt(now, [&] { replace_file(seen_, kept_text(list, first_map_)); });
  if (is_written) seen_written_ = now;
}

void BaysKeeper::retry(Timestamp now) {
  if (out_) out_->flush(now);
  if (kept_) kept_->flush(now);
}

void BaysKeeper::close(const BayList& list, Timestamp now) {
  seen_written_.reset();
  if (seen_output_) seen_output_->hurry();
  keep(list, now);
  if (out_) out_->close(now);
  if (kept_) kept_->close(now);
}

}  // namespace deltamap::daemon
