// SPDX-License-Identifier: Apache-2.0
// The signals that a daemon which may be driving a robot does not die of.
#pragma once

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <csignal>

namespace deltamap::daemon {

// Everything that would end the program without a word to the robot. A terminal that goes away (SIGHUP), or a supply
// that fails (SIGPWR), is a reason to stop. Only where no terminal can go away SIGHUP means to reload: has_terminal().
inline constexpr std::array kStopSignals{SIGTERM, SIGINT,  SIGHUP,    SIGQUIT, SIGUSR1,   SIGUSR2, SIGPWR,
                                         SIGALRM, SIGPOLL, SIGVTALRM, SIGPROF, SIGSTKFLT, SIGXCPU};
// A write that fails says so itself; a robot that drives is not put to sleep from the keyboard.
inline constexpr std::array kIgnoredSignals{SIGPIPE, SIGXFSZ, SIGTSTP, SIGTTIN, SIGTTOU};

/// As nohup and the shell's & leave them: whoever started the program wants it to go on.
[[nodiscard]] inline bool was_ignored_at_start(int signal) {
  struct sigaction now {};
  const bool may_be = signal == SIGHUP || signal == SIGINT || signal == SIGQUIT;
  return may_be && sigaction(signal, nullptr, &now) == 0 && now.sa_handler == SIG_IGN;
}

/// Whether this program hangs on a terminal. Ask at the start: with its SIGHUP the terminal is gone.
[[nodiscard]] inline bool has_terminal() {
  const int terminal = ::open("/dev/tty", O_RDONLY | O_NOCTTY | O_CLOEXEC);
  if (terminal >= 0) ::close(terminal);
  return terminal >= 0;
}

[[nodiscard]] inline sigset_t stop_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  for (const int signal : kStopSignals) {
    if (!was_ignored_at_start(signal)) sigaddset(&signals, signal);
  }
  for (int signal = SIGRTMIN; signal <= SIGRTMAX; ++signal) sigaddset(&signals, signal);
  return signals;
}

/// Before any thread: those that stop are blocked, for whoever waits for them; the others do nothing.
inline void take_signals() {
  const sigset_t signals = stop_signals();
  (void)pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  for (const int signal : kIgnoredSignals) (void)std::signal(signal, SIG_IGN);
}

}  // namespace deltamap::daemon
