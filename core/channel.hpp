// SPDX-License-Identifier: Apache-2.0
// Joins two threads: a bounded lock-free queue with one sender and one receiver. Items are moved in and out. The
// receiver sleeps until something comes; the sender never waits: a full channel refuses the newest item and counts it.
#pragma once

#include <atomic>
#include <cassert>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <optional>
#include <utility>

#include "core/semaphore.hpp"

namespace deltamap {

template <typename T>
class Channel {
 public:
  /// Holds up to `capacity` items, > 0. All memory for the slots is taken here.
  explicit Channel(std::size_t capacity) : slots_{std::make_unique<Slot[]>(capacity + 1)}, slot_count_{capacity + 1} {
    assert(capacity > 0 && "a channel must hold at least one item");
  }
  ~Channel() {
    while (take()) {
    }
  }
  Channel(const Channel&) = delete;
  Channel& operator=(const Channel&) = delete;

  /// Sender only. False, and counted as refused, where the channel is full or closed; the item is then left untouched.
  bool try_send(T&& item) {
    const std::size_t tail = tail_.load(std::memory_order_relaxed);
    const std::size_t next = following(tail);
    if (closed_.load(std::memory_order_relaxed) || next == head_.load(std::memory_order_acquire)) {
      refused_.fetch_add(1, std::memory_order_relaxed);
      return false;
    }
    new (slots_[tail].bytes) T(std::move(item));
    tail_.store(next, std::memory_order_release);
    filled_.release();
    return true;
  }

  /// Sender only: what was sent can still be received, then nothing comes any more.
  void close() {
    closed_.store(true, std::memory_order_release);
    filled_.release();
  }

  /// Receiver only. The oldest item, or nothing where there is none now.
  [[nodiscard]] std::optional<T> try_receive() {
    auto item = take();
    if (item) (void)filled_.try_acquire();  // the permit that came with it; one too many only wakes the receiver once
    return item;
  }

  /// Receiver only. Sleeps until there is an item; nothing where none has come for so long, and once the channel is
  /// closed and empty: is_drained() tells the two apart.
  template <typename Rep, typename Period>
  [[nodiscard]] std::optional<T> receive_within(const std::chrono::duration<Rep, Period>& patience) {
    if (auto item = try_receive()) return item;
    if (!closed_.load(std::memory_order_acquire)) (void)filled_.try_acquire_for(patience);
    return take();
  }
  /// Receiver only: closed and empty.
  [[nodiscard]] bool is_drained() const {
    const bool closed = closed_.load(std::memory_order_acquire);  // before looking: nothing is sent after closing
    return closed && head_.load(std::memory_order_relaxed) == tail_.load(std::memory_order_acquire);
  }

  [[nodiscard]] std::size_t capacity() const { return slot_count_ - 1; }
  /// Items that found the channel full or closed. Any thread.
  [[nodiscard]] std::uint64_t refused() const { return refused_.load(std::memory_order_relaxed); }

 private:
  struct Slot {
    alignas(T) std::byte bytes[sizeof(T)];
  };
  static constexpr std::size_t kCacheLine = 64;

  [[nodiscard]] std::size_t following(std::size_t slot) const { return slot + 1 == slot_count_ ? 0 : slot + 1; }

  [[nodiscard]] std::optional<T> take() {
    const std::size_t head = head_.load(std::memory_order_relaxed);
    if (head == tail_.load(std::memory_order_acquire)) return std::nullopt;
    T* stored = std::launder(reinterpret_cast<T*>(slots_[head].bytes));
    std::optional<T> item{std::move(*stored)};
    stored->~T();  // NOLINT(clang-analyzer-cplusplus.Move): what was moved from must be destroyed, too
    head_.store(following(head), std::memory_order_release);
    return item;
  }

  std::unique_ptr<Slot[]> slots_;
  std::size_t slot_count_;                                // one more than the capacity: full and empty differ
  alignas(kCacheLine) std::atomic<std::size_t> head_{0};  // written by the receiver
  alignas(kCacheLine) std::atomic<std::size_t> tail_{0};  // written by the sender
  Semaphore filled_;
  std::atomic<bool> closed_{false};
  std::atomic<std::uint64_t> refused_{0};
};

}  // namespace deltamap
