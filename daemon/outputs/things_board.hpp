// SPDX-License-Identifier: Apache-2.0
// The newest list of things: the map thread puts it here, control and page read it.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "mapping/things/thing.hpp"

namespace deltamap::daemon {

struct ThingList {
  std::vector<mapping::things::Thing> things;  ///< in the order of their ids
  std::uint64_t corrections = 0;               ///< changed cells that belong to no thing
  std::uint64_t forgotten = 0;                 ///< things that are no longer listed
};

class ThingsBoard {
 public:
  /// Any thread.
  void set(std::shared_ptr<const ThingList> newest) {
    const std::scoped_lock lock{mutex_};
    newest_ = std::move(newest);
  }
  /// Any thread. Never null.
  [[nodiscard]] std::shared_ptr<const ThingList> newest() const {
    const std::scoped_lock lock{mutex_};
    return newest_;
  }

 private:
  mutable std::mutex mutex_;
  std::shared_ptr<const ThingList> newest_ = std::make_shared<const ThingList>();
};

}  // namespace deltamap::daemon
