// SPDX-License-Identifier: Apache-2.0
// The newest states of all bays: the delta thread puts them here, control and page read them.
#pragma once

#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "mapping/bays/bay.hpp"

namespace deltamap::daemon {

struct BayList {
  std::vector<mapping::bays::Bay> bays;
  std::vector<mapping::bays::BayStatus> statuses;  ///< of each
};

class BaysBoard {
 public:
  /// Any thread.
  void set(std::shared_ptr<const BayList> newest) {
    const std::scoped_lock lock{mutex_};
    newest_ = std::move(newest);
  }
  /// Any thread. Never null.
  [[nodiscard]] std::shared_ptr<const BayList> newest() const {
    const std::scoped_lock lock{mutex_};
    return newest_;
  }

 private:
  mutable std::mutex mutex_;
  std::shared_ptr<const BayList> newest_ = std::make_shared<const BayList>();
};

}  // namespace deltamap::daemon
