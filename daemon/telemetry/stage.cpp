// SPDX-License-Identifier: Apache-2.0
#include "daemon/telemetry/stage.hpp"

#include <pthread.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <chrono>
#include <ctime>
#include <exception>

namespace deltamap::daemon {
namespace {

double cpu_s_of(clockid_t clock) {
  timespec time{};
  (void)clock_gettime(clock, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

std::int64_t steady_ns() { return std::chrono::steady_clock::now().time_since_epoch().count(); }

// Linux keeps niceness by thread (setpriority(2), notes).
void step_back(int niceness) {
  if (niceness != 0) (void)setpriority(PRIO_PROCESS, static_cast<id_t>(syscall(SYS_gettid)), niceness);
}

}  // namespace

double thread_cpu_s() { return cpu_s_of(CLOCK_THREAD_CPUTIME_ID); }
double process_cpu_s() { return cpu_s_of(CLOCK_PROCESS_CPUTIME_ID); }

void Pulse::beat() { beat_ns_.store(steady_ns(), std::memory_order_relaxed); }

double Pulse::silence_s() const {
  return 1e-9 * static_cast<double>(steady_ns() - beat_ns_.load(std::memory_order_relaxed));
}

Stage::Stage(Options options, std::function<void()> body, std::function<void(const std::string&)> on_failure)
    : thread_{[this, options = std::move(options), body = std::move(body), on_failure = std::move(on_failure)] {
        (void)pthread_setname_np(pthread_self(), options.name.c_str());
        step_back(options.niceness);
        clockid_t clock = 0;
        if (pthread_getcpuclockid(pthread_self(), &clock) == 0) clock_.store(clock, std::memory_order_relaxed);
        try {
          body();
        } catch (const std::exception& error) {
          on_failure(options.name + " stage: " + error.what());
        }
        clock_.store(0, std::memory_order_relaxed);
        cpu_s_ = thread_cpu_s();
      }} {}

std::optional<double> Stage::cpu_now_s() const {
  const clockid_t clock = clock_.load(std::memory_order_relaxed);
  timespec time{};
  if (clock == 0 || clock_gettime(clock, &time) != 0) return std::nullopt;  // the thread has just ended
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

void Stage::join() {
  if (thread_.joinable()) thread_.join();
}

}  // namespace deltamap::daemon
