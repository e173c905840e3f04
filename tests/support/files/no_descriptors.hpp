// SPDX-License-Identifier: Apache-2.0
// As long as it lives, this process can open nothing more.
#pragma once

#include <sys/eventfd.h>
#include <sys/resource.h>
#include <unistd.h>

#include <vector>

namespace deltamap::test {

class NoDescriptors {
 public:
  NoDescriptors() {
    (void)::getrlimit(RLIMIT_NOFILE, &before_);
    take();  // the number that is free next tells how far the limit must reach
    const rlimit limit{static_cast<rlim_t>(taken_.back()) + 64, before_.rlim_max};
    (void)::setrlimit(RLIMIT_NOFILE, &limit);
    while (take()) {
    }
  }
  ~NoDescriptors() {
    for (const int descriptor : taken_) ::close(descriptor);
    (void)::setrlimit(RLIMIT_NOFILE, &before_);
  }
  NoDescriptors(const NoDescriptors&) = delete;
  NoDescriptors& operator=(const NoDescriptors&) = delete;

  /// What has come free meanwhile, too.
  bool take() {
    const int descriptor = ::eventfd(0, EFD_CLOEXEC);
    if (descriptor >= 0) taken_.push_back(descriptor);
    return descriptor >= 0;
  }

 private:
  rlimit before_{};
  std::vector<int> taken_;
};

}  // namespace deltamap::test
