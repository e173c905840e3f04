// SPDX-License-Identifier: Apache-2.0
// The live page's server on a thread of its own, for tests over real sockets.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <thread>

#include "daemon/dashboard/server.hpp"

namespace deltamap::test {

/// Whoever adds members that `options_` refers to calls stop() in a destructor of its own: the server uses them until
/// then.
class ServedPage : public testing::Test {
 protected:
  ~ServedPage() override { stop(); }

  void start() {
    server_ = std::make_unique<daemon::dashboard::Server>(options_);
    thread_ = std::thread([this] { server_->run(); });
  }
  void stop() {
    if (!thread_.joinable()) return;
    server_->stop();
    thread_.join();
  }
  [[nodiscard]] std::uint16_t port() const { return server_->port(); }

  daemon::dashboard::Server::Options options_;
  std::unique_ptr<daemon::dashboard::Server> server_;

 private:
  std::thread thread_;
};

}  // namespace deltamap::test
