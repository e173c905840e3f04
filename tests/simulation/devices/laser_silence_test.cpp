// SPDX-License-Identifier: Apache-2.0
// How soon scans come again once a laser that was silent speaks again: the session against the virtual laser, in
// virtual time, over seeded silences of 1 to 60 s, a third of them 4 s long.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ostream>

#include "core/random.hpp"
#include "drivers/lms200/session.hpp"
#include "simulation/devices/virtual_lms200.hpp"
#include "tests/support/files/figure.hpp"

namespace deltamap::simulation::devices {
namespace {

namespace lms200 = drivers::lms200;

constexpr Timestamp kStart = timestamp_from_ns(1'000'000'000'000);
constexpr int kSilences = 100;
constexpr double kWorst_s = 2.0;

enum class Silence { kStreamGoesOn, kAnswersOnRequest, kPowerCut, kCablePulled };

struct SilenceCase {
  const char* name;
  Silence kind;
  unsigned baud;
  lms200::ScanVariant variant;

  friend std::ostream& operator<<(std::ostream& out, const SilenceCase& tested) { return out << tested.name; }
};

/// The session on its port, the port on the laser.
class Line {
 public:
  Line(const SilenceCase& tested, std::uint64_t seed)
      : session_{{.variant = tested.variant, .baud = tested.baud}, drivers::SessionMode::kLive},
        laser_{{}, kStart, Random{seed}} {
    open();
  }

  void open() {
    is_plugged_in_ = true;
    carry_out(session_.start(now));
  }
  void pull_cable() {
    is_plugged_in_ = false;
    wake_at_.reset();
  }

  void run_until(Timestamp end) {
    while (now < end) step(end);
  }
  /// Seconds until a scan comes.
  double wait_for_scan(double at_most_s) {
    const Timestamp begin = now;
    const std::size_t before = scans;
    while (scans == before && seconds(now - begin) < at_most_s) step(begin + duration_from_seconds(at_most_s));
    return seconds(now - begin);
  }

  VirtualLms200& laser() { return laser_; }
  [[nodiscard]] const lms200::Lms200Session& session() const { return session_; }

  Timestamp now = kStart;
  std::size_t scans = 0;
  int failures = 0;

 private:
  void step(Timestamp end) {
    Timestamp next = std::min(end, now + std::chrono::milliseconds{5});
    if (const auto event = laser_.next_event(); event && *event > now) next = std::min(next, *event);
    if (wake_at_ && *wake_at_ > now) next = std::min(next, *wake_at_);
    now = next;
    laser_.advance(now, [](const SweepRequest& request) {
      return std::vector<Beam>(request.variant.values(), Beam{3.0F, 0.0F, BeamKind::kRange});
    });
    const auto bytes = laser_.transmitted(now, baud_);
    if (!is_plugged_in_) return;
    if (!bytes.empty()) carry_out(session_.on_bytes(bytes, now));
    if (wake_at_ && *wake_at_ <= now) carry_out(session_.on_time(now));
  }

  void carry_out(lms200::Lms200Output out) {
    for (const drivers::PortRequest& request : out.output.requests) {
      using Kind = drivers::PortRequest::Kind;
      if (request.kind == Kind::kSetBaud) baud_ = request.baud;
      if (request.kind == Kind::kWrite) laser_.receive(request.bytes, baud_, now);
    }
    scans += out.scans.size();
    wake_at_ = out.output.wake_at;
    if (!out.output.failed) return;
    ++failures;
    carry_out(session_.start(now));
  }

  lms200::Lms200Session session_;
  VirtualLms200 laser_;
  unsigned baud_ = 9600;
  bool is_plugged_in_ = true;
  std::optional<Timestamp> wake_at_;
};

/// Lets the laser be silent and answers how long after it speaks again a scan comes.
double delay_after(Line& line, Silence kind, double silence_s) {
  const Timestamp end = line.now + duration_from_seconds(silence_s);
  switch (kind) {
    case Silence::kStreamGoesOn:
    case Silence::kAnswersOnRequest:
      line.laser().fall_silent(line.now, end, kind == Silence::kAnswersOnRequest);
      break;
    case Silence::kPowerCut:
      line.laser().cut_power(line.now, silence_s);
      break;
    case Silence::kCablePulled:
      line.pull_cable();
      break;
  }
  line.run_until(end);
  if (kind == Silence::kCablePulled) line.open();
  return line.wait_for_scan(60.0);
}

class LaserSilence : public ::testing::TestWithParam<SilenceCase> {};

TEST_P(LaserSilence, EndsWithinTwoSeconds) {
  const SilenceCase& tested = GetParam();
  Random random{7};
  Line line{tested, 3};
  ASSERT_LT(line.wait_for_scan(30.0), 10.0);
  std::vector<double> delays_s;
  for (int i = 0; i < kSilences; ++i) {
    line.run_until(line.now + duration_from_seconds(random.uniform(3.0, 6.0)));
    ASSERT_TRUE(line.session().is_streaming());
    const double silence_s = i % 3 == 0 ? 4.0 : random.uniform(1.0, 60.0);
    delays_s.push_back(delay_after(line, tested.kind, silence_s));
    EXPECT_LE(delays_s.back(), kWorst_s) << "after " << silence_s << " s, silence " << i;
  }
  EXPECT_EQ(line.laser().baud(), tested.baud);
  EXPECT_EQ(line.laser().variant(), tested.variant);
  std::sort(delays_s.begin(), delays_s.end());
  const auto ms = [&](double share) {
    return std::round(1e3 * delays_s[static_cast<std::size_t>(share * (kSilences - 1))]);
  };
  const std::string name{tested.name};
  test::tell_figure(name + "_median", ms(0.5), "ms");
  test::tell_figure(name + "_p95", ms(0.95), "ms");
  test::tell_figure(name + "_worst", ms(1.0), "ms");
}

constexpr lms200::ScanVariant kCoarse{180, 100};
constexpr lms200::ScanVariant kFine{180, 50};

INSTANTIATE_TEST_SUITE_P(Every, LaserSilence,
                         ::testing::Values(SilenceCase{"StreamGoesOn", Silence::kStreamGoesOn, 38400, kCoarse},
                                           SilenceCase{"StreamGoesOnFine", Silence::kStreamGoesOn, 38400, kFine},
                                           SilenceCase{"StreamGoesOnFast", Silence::kStreamGoesOn, 500000, kFine},
                                           SilenceCase{"AnswersOnRequest", Silence::kAnswersOnRequest, 38400, kFine},
                                           SilenceCase{"AnswersOnRequestFast", Silence::kAnswersOnRequest, 500000,
                                                       kFine},
                                           SilenceCase{"PowerCut", Silence::kPowerCut, 38400, kFine},
                                           SilenceCase{"PowerCutFast", Silence::kPowerCut, 500000, kFine},
                                           SilenceCase{"CablePulled", Silence::kCablePulled, 38400, kFine},
                                           SilenceCase{"CablePulledFast", Silence::kCablePulled, 500000, kFine}),
                         [](const auto& instance) { return std::string(instance.param.name); });

}  // namespace
}  // namespace deltamap::simulation::devices
