// SPDX-License-Identifier: Apache-2.0
#include "tool/progress.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <utility>

namespace deltamap::tool {
namespace {
constexpr int kBarCells = 40;
}

std::string time_left(double passed_s, double share) {
  constexpr double kLeastS = 5.0;
  constexpr double kLeastShare = 0.01;
  if (share < kLeastShare) return "";
  const double left_s = passed_s * (1.0 - share) / share;
  if (left_s < kLeastS) return "";
  char text[32];
  if (left_s < 99.5) {
    (void)std::snprintf(text, sizeof text, "%.0f s left", left_s);
  } else if (left_s < 99.5 * 60.0) {
    (void)std::snprintf(text, sizeof text, "%.0f min left", left_s / 60.0);
  } else {
    (void)std::snprintf(text, sizeof text, "%.1f h left", left_s / 3600.0);
  }
  return text;
}

Progress::Progress(std::string what, std::uint64_t total)
    : what_{std::move(what)}, total_{total}, on_terminal_{::isatty(STDERR_FILENO) == 1} {}

Progress::~Progress() {
  if (on_terminal_ && shown_percent_ >= 0) std::fputs("\r\033[K", stderr);
}

void Progress::show(std::uint64_t done) {
  if (!on_terminal_ || total_ == 0) return;
  const int percent =
      static_cast<int>(100.0 * static_cast<double>(std::min(done, total_)) / static_cast<double>(total_));
  if (percent == shown_percent_) return;
  shown_percent_ = percent;
  const std::string filled(static_cast<std::size_t>(percent * kBarCells / 100), '#');
  const double passed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - began_).count();
  const std::string left = time_left(passed_s, static_cast<double>(done) / static_cast<double>(total_));
  std::fprintf(stderr, "\r%s [%-*s] %3d %% %s\033[K", what_.c_str(), kBarCells, filled.c_str(), percent, left.c_str());
  std::fflush(stderr);
}

}  // namespace deltamap::tool
