// SPDX-License-Identifier: Apache-2.0
#include "daemon/live/hand_drive.hpp"

#include <cmath>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

namespace deltamap::daemon {
namespace {

using Json = nlohmann::ordered_json;
using dashboard::Message;

constexpr double kBeatPeriod_s = 0.09;  // with a look every 0.1 s: ten a second
constexpr int kMostAnswers = 40;        // of a driver to one beat; a person on a pad gives a few
constexpr double kSilence_s = 1.0;      // after which a driver counts as gone

Message message_of(const Json& json) {
  const std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  return {.is_binary = false, .bytes = std::make_shared<const std::string>(text)};
}

struct Spoken {
  std::uint64_t beat = 0;
  double speed_m_per_s = 0.0;
  double turn_rate_rad_per_s = 0.0;
};

std::optional<Spoken> spoken_in(const std::string& text) {
  const Json json = Json::parse(text, nullptr, false);
  if (!json.is_object()) return std::nullopt;
  const auto beat = json.find("beat");
  const auto speed = json.find("speed_m_per_s");
  const auto turn = json.find("turn_rate_rad_per_s");
  const bool is_whole = beat != json.end() && speed != json.end() && turn != json.end() && beat->is_number_unsigned() &&
                        speed->is_number() && turn->is_number();
  if (!is_whole) return std::nullopt;
  const Spoken spoken{beat->get<std::uint64_t>(), speed->get<double>(), turn->get<double>()};
  if (!std::isfinite(spoken.speed_m_per_s) || !std::isfinite(spoken.turn_rate_rad_per_s)) return std::nullopt;
  return spoken;
}

}  // namespace

struct HandDrive::Answered {
  std::mutex mutex;
  std::optional<control::CommandOutcome> outcome;
};

HandDrive::HandDrive(std::uint64_t who, Hand hand, const Telemetry& telemetry, Now now)
    : who_{who},
      hand_{std::move(hand)},
      telemetry_{telemetry},
      now_{std::move(now)},
      answered_{std::make_shared<Answered>()},
      heard_at_{now_()} {
  hand_.take(who_, [answered = answered_](const control::CommandOutcome& outcome) {
    const std::scoped_lock lock{answered->mutex};
    answered->outcome = outcome;
  });
}

HandDrive::~HandDrive() { hand_.let_go(who_); }

void HandDrive::hear(const std::string& message) {
  if (stage_ == Stage::kOver) return;
  const auto spoken = spoken_in(message);
  if (!spoken) return end("refused", "a message needs the numbers beat, speed_m_per_s and turn_rate_rad_per_s");
  if (++answers_ > kMostAnswers) return end("refused", "too many messages");
  heard_at_ = now_();
  const bool is_known = spoken->beat < beats_ && spoken->beat + sent_at_.size() >= beats_;
  if (stage_ != Stage::kDrives || !is_known) return;
  hand_.drive(who_, {.time = sent_at(spoken->beat),
                     .speed_m_per_s = spoken->speed_m_per_s,
                     .turn_rate_rad_per_s = spoken->turn_rate_rad_per_s});
}

std::optional<Message> HandDrive::next() {
  const Timestamp now = now_();
  if (stage_ == Stage::kAsked) {
    begin_where_taken();
    if (stage_ == Stage::kDrives) return message_of({{"type", "taken"}});
  }
  if (stage_ != Stage::kOver) end_where_nobody_is_there(now);
  if (stage_ == Stage::kOver) {
    if (last_word_.empty()) return std::nullopt;
    return Message{.is_binary = false, .bytes = std::make_shared<const std::string>(std::exchange(last_word_, {}))};
  }
  const bool is_due = beats_ == 0 || seconds(now - sent_at(beats_ - 1)) >= kBeatPeriod_s;
  if (stage_ != Stage::kDrives || !is_due) return std::nullopt;
  sent_at(beats_) = now;
  answers_ = 0;
  return message_of({{"type", "beat"}, {"number", beats_++}});
}

void HandDrive::begin_where_taken() {
  if (stage_ != Stage::kAsked) return;
  const std::scoped_lock lock{answered_->mutex};
  if (!answered_->outcome) return;
  if (!answered_->outcome->done) return end("refused", answered_->outcome->message);
  stage_ = Stage::kDrives;
}

void HandDrive::end_where_nobody_is_there(Timestamp now) {
  if (seconds(now - heard_at_) > kSilence_s) return end("ended", "nothing has been heard for a second");
  if (stage_ == Stage::kDrives && !telemetry_.by_hand.value()) end("ended", "driving was switched off");
}

void HandDrive::end(const std::string& type, const std::string& why) {
  hand_.let_go(who_);
  stage_ = Stage::kOver;
  last_word_ = Json{{"type", type}, {"why", why}}.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace deltamap::daemon
