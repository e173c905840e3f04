// SPDX-License-Identifier: Apache-2.0
// While it lives, this process is not root, to whom every file may be read and written.
#pragma once

#include <unistd.h>

#include <stdexcept>

namespace deltamap::test {

class NotRoot {
 public:
  NotRoot() {
    if (was_root_ && ::seteuid(65534) != 0) throw std::runtime_error("cannot be another user here");
  }
  ~NotRoot() {
    if (was_root_) (void)!::seteuid(0);
  }
  NotRoot(const NotRoot&) = delete;
  NotRoot& operator=(const NotRoot&) = delete;

 private:
  bool was_root_ = ::geteuid() == 0;
};

}  // namespace deltamap::test
