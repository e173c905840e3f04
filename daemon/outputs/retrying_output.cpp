// SPDX-License-Identifier: Apache-2.0
#include "daemon/outputs/retrying_output.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <utility>

namespace deltamap::daemon {
namespace {

constexpr Duration kFirstPause = std::chrono::seconds(1);
constexpr Duration kLongestPause = std::chrono::seconds(8);

}  // namespace

RetryingOutput::RetryingOutput(std::string name, const std::filesystem::path& file, OutputBoard& board, Warn warn)
    : board_{board}, warn_{std::move(warn)} {
  status_.name = std::move(name);
  status_.file = file.string();
  board_.set(status_);
}

bool RetryingOutput::attempt(Timestamp now, const std::function<void()>& write) {
  if (ended_ || (!works() && now < next_attempt_)) return false;
  try {
    write();
  } catch (const std::exception& error) {
    fail(now, error.what());
    return false;
  }
  if (works()) return true;
  const long paused_s = std::lround(seconds(now - status_.since));
  status_.written = true;
  status_.why.clear();
  board_.set(status_);
  warn_("saving goes on: " + status_.name + " after " + std::to_string(paused_s) + " s: " + status_.file +
        (status_.lost > 0 ? " lost=" + std::to_string(status_.lost) : std::string{}));
  return true;
}

void RetryingOutput::fail(Timestamp now, const std::string& why) {
  const bool is_new = works();
  pause_ = is_new ? kFirstPause : std::min(2 * pause_, kLongestPause);
  next_attempt_ = now + pause_;
  if (is_new) status_.since = now;
  status_.written = false;
  status_.why = why;
  board_.set(status_);
  if (is_new) warn_("saving pauses: " + status_.name + ": " + why);
}

void RetryingOutput::end(Timestamp now, const std::string& why) {
  ended_ = true;
  status_.written = false;
  status_.since = now;
  status_.why = why;
  board_.set(status_);
}

void RetryingOutput::begin_again() {
  ended_ = false;
  status_.written = true;
  status_.why.clear();
  board_.set(status_);
}

void RetryingOutput::count_lost(std::uint64_t count) {
  status_.lost += count;
  board_.set(status_);
}

}  // namespace deltamap::daemon
