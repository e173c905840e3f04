// SPDX-License-Identifier: Apache-2.0
// The newest of something that one thread makes and others read.
#pragma once

#include <memory>
#include <mutex>
#include <utility>

namespace deltamap::daemon {

template <class Content>
class NewestBoard {
 public:
  /// Any thread.
  void set(std::shared_ptr<const Content> newest) {
    const std::scoped_lock lock{mutex_};
    newest_ = std::move(newest);
  }
  /// Any thread. Never null.
  [[nodiscard]] std::shared_ptr<const Content> newest() const {
    const std::scoped_lock lock{mutex_};
    return newest_;
  }

 private:
  mutable std::mutex mutex_;
  std::shared_ptr<const Content> newest_ = std::make_shared<const Content>();
};

}  // namespace deltamap::daemon
