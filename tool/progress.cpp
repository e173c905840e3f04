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
  std::fprintf(stderr, "\r%s [%-*s] %3d %%", what_.c_str(), kBarCells, filled.c_str(), percent);
  std::fflush(stderr);
}

}  // namespace deltamap::tool
