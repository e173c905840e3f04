// SPDX-License-Identifier: Apache-2.0
#include "core/channel.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <thread>

namespace deltamap {
namespace {

TEST(Channel, KeepsTheOrderAndMovesItsItems) {
  Channel<std::unique_ptr<int>> channel{4};
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(channel.try_send(std::make_unique<int>(i)));
  for (int i = 0; i < 3; ++i) EXPECT_EQ(**channel.try_receive(), i);
  EXPECT_FALSE(channel.try_receive().has_value());
}

TEST(Channel, RefusesTheNewestItemWhenFullLeavesItAndCountsIt) {
  Channel<std::unique_ptr<int>> channel{1};
  EXPECT_TRUE(channel.try_send(std::make_unique<int>(1)));
  auto second = std::make_unique<int>(2);
  EXPECT_FALSE(channel.try_send(std::move(second)));
  ASSERT_NE(second, nullptr);
  EXPECT_EQ(channel.refused(), 1u);
  EXPECT_EQ(**channel.try_receive(), 1);
  EXPECT_TRUE(channel.try_send(std::move(second)));
}

/// Sends 0, 1, 2 … as fast as they are taken, then closes the channel.
template <typename Item, typename Make = std::identity>
std::jthread counting_sender(Channel<Item>& channel, int count, const Make& make = {}) {
  return std::jthread{[&channel, count, make] {
    for (int i = 0; i < count; ++i) {
      Item item = make(i);
      while (!channel.try_send(std::move(item))) std::this_thread::yield();
    }
    channel.close();
  }};
}

/// Whoever is not woken waits for an hour.
template <typename Item>
std::optional<Item> next_of(Channel<Item>& channel) {
  while (!channel.is_drained()) {
    if (auto item = channel.receive_within(std::chrono::hours{1})) return item;
  }
  return std::nullopt;
}

TEST(Channel, GivesEverythingInOrderAcrossThreads) {
  constexpr int kCount = 100'000;
  Channel<std::unique_ptr<int>> channel{64};
  const std::jthread sender = counting_sender(channel, kCount, [](int i) { return std::make_unique<int>(i); });
  int expected = 0;
  while (auto item = next_of(channel)) ASSERT_EQ(**item, expected++);
  EXPECT_EQ(expected, kCount);
}

TEST(Channel, MixesPollingAndSleepingWithoutLosingAWakeUp) {
  constexpr int kCount = 20'000;
  Channel<int> channel{8};
  const std::jthread sender = counting_sender(channel, kCount);
  int expected = 0;
  while (auto item = next_of(channel)) {
    ASSERT_EQ(*item, expected++);
    while (auto more = channel.try_receive()) ASSERT_EQ(*more, expected++);
  }
  EXPECT_EQ(expected, kCount);
}

TEST(Channel, WakesTheReceiverWhenItIsClosed) {
  Channel<int> channel{1};
  const std::jthread receiver{[&] { EXPECT_FALSE(next_of(channel).has_value()); }};
  channel.close();
}

TEST(Channel, GivesWhatIsLeftAfterClosingThenNothing) {
  Channel<int> channel{2};
  EXPECT_TRUE(channel.try_send(7));
  channel.close();
  EXPECT_FALSE(channel.try_send(8));
  EXPECT_EQ(next_of(channel), 7);
  EXPECT_EQ(next_of(channel), std::nullopt);
}

TEST(Channel, WaitsNoLongerThanItIsAskedTo) {
  Channel<int> channel{2};
  EXPECT_FALSE(channel.receive_within(std::chrono::milliseconds{1}));
  EXPECT_FALSE(channel.is_drained());
  EXPECT_TRUE(channel.try_send(7));
  channel.close();
  EXPECT_FALSE(channel.is_drained()) << "there is one left";
  EXPECT_EQ(channel.receive_within(std::chrono::hours{1}), 7);
  EXPECT_TRUE(channel.is_drained());
  EXPECT_FALSE(channel.receive_within(std::chrono::hours{1})) << "closed: it waits for nothing";
}

TEST(Channel, GivesEverythingInOrderToAReceiverThatLooksUpNowAndThen) {
  constexpr int kCount = 20'000;
  Channel<int> channel{8};
  const std::jthread sender = counting_sender(channel, kCount);
  int expected = 0;
  while (!channel.is_drained()) {
    const auto item = channel.receive_within(std::chrono::milliseconds{200});
    if (!item) continue;
    ASSERT_EQ(*item, expected++);
  }
  EXPECT_EQ(expected, kCount);
}

TEST(Channel, DestroysWhatNobodyReceived) {
  const auto item = std::make_shared<int>(1);
  {
    Channel<std::shared_ptr<int>> channel{2};
    EXPECT_TRUE(channel.try_send(std::shared_ptr<int>{item}));
    EXPECT_EQ(item.use_count(), 2);
  }
  EXPECT_EQ(item.use_count(), 1);
}

}  // namespace
}  // namespace deltamap
