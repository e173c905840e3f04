// SPDX-License-Identifier: Apache-2.0
#include "tool/live_ports.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace deltamap::tool {
namespace {

volatile std::sig_atomic_t stop_requested = 0;

void request_stop(int) { stop_requested = 1; }

Duration reading_of(clockid_t clock) {
  timespec now{};
  ::clock_gettime(clock, &now);
  return std::chrono::seconds{now.tv_sec} + std::chrono::nanoseconds{now.tv_nsec};
}

}  // namespace

StopSignals::StopSignals() {
  stop_requested = 0;
  struct sigaction action {};
  action.sa_handler = request_stop;
  sigemptyset(&action.sa_mask);
  sigset_t held;
  sigemptyset(&held);
  for (const int signal : {SIGTERM, SIGINT}) {
    ::sigaction(signal, &action, nullptr);
    sigaddset(&held, signal);
  }
  ::pthread_sigmask(SIG_BLOCK, &held, &before_);
}
StopSignals::~StopSignals() { ::pthread_sigmask(SIG_SETMASK, &before_, nullptr); }

bool StopSignals::was_asked() const { return stop_requested != 0; }

SteadyClock::SteadyClock() : offset_{reading_of(CLOCK_REALTIME) - reading_of(CLOCK_MONOTONIC)} {}
Timestamp SteadyClock::now() const { return Timestamp{reading_of(CLOCK_MONOTONIC) + offset_}; }

LinksFolder::LinksFolder(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  descriptor_ = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor_ < 0) throw std::runtime_error(folder.string() + ": " + std::strerror(errno));
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) == 0) return;
  ::close(descriptor_);
  throw std::runtime_error(folder.string() + ": another simulator has its links here");
}
LinksFolder::~LinksFolder() { ::close(descriptor_); }

void sleep_until(Timestamp wake, std::vector<pollfd> watched, const SteadyClock& clock, const StopSignals& signals) {
  const Duration left = std::max(Duration{0}, wake - clock.now());
  const auto whole = std::chrono::duration_cast<std::chrono::seconds>(left);
  const timespec timeout{static_cast<time_t>(whole.count()), static_cast<long>((left - whole).count())};
  ::ppoll(watched.data(), watched.size(), &timeout, &signals.while_asleep());
}

}  // namespace deltamap::tool
