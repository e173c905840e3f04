// SPDX-License-Identifier: Apache-2.0
// One person who drives by the page. The page hears a numbered beat ten times a second and answers each with what the
// keys say; an answer counts only for a moment after its beat was sent, however long it was on its way. So a lost
// connection, a slow network, a closed tab and a released key all end alike: the robot stands. Page thread.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <string>

#include "core/messages.hpp"
#include "daemon/control/command.hpp"
#include "daemon/dashboard/request.hpp"
#include "daemon/telemetry/telemetry.hpp"

namespace deltamap::daemon {

/// What of the robot is reached by hand (IoStage). Any thread. `who`: a number of each person who drives, not 0.
struct Hand {
  std::function<void(std::uint64_t who, std::function<void(const control::CommandOutcome&)> answer)> take{};
  std::function<void(std::uint64_t who, const DriveCommand&)> drive{};
  std::function<void(std::uint64_t who)> let_go{};
};

class HandDrive final : public dashboard::Dialog {
 public:
  using Now = std::function<Timestamp()>;
  HandDrive(std::uint64_t who, Hand hand, const Telemetry& telemetry, Now now);
  ~HandDrive() override;

  void hear(const std::string& message) override;
  [[nodiscard]] std::optional<dashboard::Message> next() override;
  [[nodiscard]] bool is_over() const override { return stage_ == Stage::kOver; }

 private:
  enum class Stage : std::uint8_t { kAsked, kDrives, kOver };
  struct Answered;  // by the io thread

  void end(const std::string& type, const std::string& why);
  void begin_where_taken();
  void end_where_nobody_is_there(Timestamp now);
  /// When one of the newest beats was sent.
  Timestamp& sent_at(std::uint64_t beat) { return sent_at_[static_cast<std::size_t>(beat % sent_at_.size())]; }

  std::uint64_t who_;
  Hand hand_;
  const Telemetry& telemetry_;
  Now now_;
  std::shared_ptr<Answered> answered_;
  Stage stage_ = Stage::kAsked;
  std::string last_word_;             // to be sent
  std::uint64_t beats_ = 0;           // sent so far; beat n at n modulo their number
  std::array<Timestamp, 8> sent_at_;  // the newest
  Timestamp heard_at_;
  int answers_ = 0;  // since the newest beat
};

}  // namespace deltamap::daemon
