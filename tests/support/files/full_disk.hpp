// SPDX-License-Identifier: Apache-2.0
// While it lives, files of this process cannot grow beyond a size: what a full disk does to a writer, without one.
#pragma once

#include <sys/resource.h>

#include <csignal>

namespace deltamap::test {

class FullDisk {
 public:
  explicit FullDisk(rlim_t most_bytes = 0) {
    (void)std::signal(SIGXFSZ, SIG_IGN);  // as the daemon has it: the write says what is wrong
    (void)getrlimit(RLIMIT_FSIZE, &before_);
    rlimit limit = before_;
    limit.rlim_cur = most_bytes;
    (void)setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FullDisk() { (void)setrlimit(RLIMIT_FSIZE, &before_); }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  rlimit before_{};
};

}  // namespace deltamap::test
