// SPDX-License-Identifier: Apache-2.0
#include "daemon/kept/kept_stability.hpp"

#include <gtest/gtest.h>

#include "localization/belief/stability.hpp"
#include "tests/support/files/temporary_folder.hpp"

namespace deltamap::daemon {
namespace {

using localization::belief::Stability;

constexpr Cell kProven{10, 10};
const GridGeometry kGeometry{40, 30, 0.05, {-1.0, 2.0}};

/// One tile that was confirmed from all around, for long enough.
Stability with_a_proven_tile() {
  Stability stability{kGeometry};
  for (int i = 0; i < 40; ++i) {
    const double angle = 0.7 * i;
    stability.confirm(kProven, {3.0 * std::cos(angle), 3.0 * std::sin(angle)}, timestamp_from_ns(i * 60'000'000'000));
  }
  return stability;
}

KeptStability some_stability() { return {7, 3, with_a_proven_tile().record()}; }

TEST(KeptStability, ComesBackAsItWas) {
  ASSERT_TRUE(with_a_proven_tile().proven(kProven));
  const test::TemporaryFolder folder;
  const auto file = folder.write("store.stability", file_text(some_stability()));
  const KeptStabilityAnswer answer = read_kept_stability(file, 7);
  ASSERT_TRUE(answer.kept) << answer.why_not;
  EXPECT_EQ(answer.kept->revision, 3u);
  EXPECT_NE(answer.fingerprint, 0u);
  Stability restored{kGeometry};
  ASSERT_TRUE(restored.restore(answer.kept->record));
  EXPECT_TRUE(restored.proven(kProven));
  EXPECT_EQ(restored.proven_tiles(), 1u);
}

TEST(KeptStability, EveryCutAndEveryFlippedByteIsRefused) {
  const test::TemporaryFolder folder;
  const std::string whole = file_text(some_stability());
  const auto is_refused = [&](const std::string& text) {
    const auto file = folder.write("store.stability", text);
    const KeptStabilityAnswer answer = read_kept_stability(file, 7);
    return !answer.kept && answer.fingerprint == 0 && answer.why_not.starts_with(file.string() + ": ");
  };
  EXPECT_FALSE(is_refused(whole));
  for (std::size_t length = 0; length < whole.size(); length += 7) EXPECT_TRUE(is_refused(whole.substr(0, length)));
  for (std::size_t at = whole.find('\n') + 1; at < whole.size(); ++at) {
    std::string flipped = whole;
    flipped[at] = static_cast<char>(flipped[at] ^ 1);
    EXPECT_TRUE(is_refused(flipped)) << at;
  }
  EXPECT_TRUE(is_refused("{}\n"));
}

TEST(KeptStability, OfAnotherMapIsNotUsedAndWithoutAFileThereIsNothingToSay) {
  const test::TemporaryFolder folder;
  const auto file = folder.write("store.stability", file_text(some_stability()));
  EXPECT_EQ(read_kept_stability(file, 8).why_not, file.string() + ": what has proven stable belongs to another map");
  EXPECT_EQ(read_kept_stability(folder.path() / "missing", 7).why_not, "");
}

TEST(KeptStability, CellsThatWereRewrittenSinceBeginAgain) {
  const CellChange rewritten{kProven, CellState::kOccupied, CellState::kFree};
  const auto record = without(with_a_proven_tile().record(), std::span{&rewritten, 1});
  Stability restored{kGeometry};
  ASSERT_TRUE(restored.restore(record));
  EXPECT_FALSE(restored.proven(kProven));
}

}  // namespace
}  // namespace deltamap::daemon
