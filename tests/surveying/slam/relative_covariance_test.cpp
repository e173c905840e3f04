// SPDX-License-Identifier: Apache-2.0
#include "surveying/slam/relative_covariance.hpp"

#include <gtest/gtest.h>

#include <array>

#include "core/random.hpp"

namespace deltamap::surveying::slam {
namespace {

PoseCovariance diagonal(double metres, double rad) {
  return Eigen::Vector3d{metres * metres, metres * metres, rad * rad}.asDiagonal();
}

Pose2 drawn(const Pose2& mean, double metres, double rad, Random& random) {
  return {mean.x + random.normal(metres), mean.y + random.normal(metres), mean.theta + random.normal(rad)};
}

/// Of what `made(Random&)` answers, about `mean`.
template <typename Made>
PoseCovariance sampled(const Pose2& mean, Made&& made) {
  Random random{7};
  constexpr int kSamples = 40000;
  PoseCovariance sum = PoseCovariance::Zero();
  for (int i = 0; i < kSamples; ++i) {
    const Eigen::Vector3d off = difference(mean, made(random));
    sum += off * off.transpose() / kSamples;
  }
  return sum;
}

void expect_near(const PoseCovariance& a, const PoseCovariance& b) {
  EXPECT_LT((a - b).cwiseAbs().maxCoeff(), 0.04 * b.cwiseAbs().maxCoeff()) << a << "\n\n" << b;
}

constexpr Pose2 kFirst{2.0, -1.0, 0.8};
constexpr Pose2 kSecond{3.0, 1.5, -0.6};

TEST(RelativeCovariance, OfTwoMotionsIsThatOfTheirSamples) {
  expect_near(composed_covariance(kFirst, diagonal(0.05, 0.02), kSecond, diagonal(0.03, 0.01)),
              sampled(kFirst * kSecond, [](Random& random) {
                return drawn(kFirst, 0.05, 0.02, random) * drawn(kSecond, 0.03, 0.01, random);
              }));
}

TEST(RelativeCovariance, OfTheWayBackIsThatOfItsSamples) {
  expect_near(inverted_covariance(kFirst, diagonal(0.05, 0.02)),
              sampled(inverse(kFirst), [](Random& random) { return inverse(drawn(kFirst, 0.05, 0.02, random)); }));
}

constexpr std::array<std::uint32_t, 5> kAll{0, 1, 2, 3, 4};

/// Four keyframes in a row, a metre apart; the fifth hangs on nothing.
Survey row_of_keyframes() {
  Survey survey;
  survey.component = {0};
  for (int i = 0; i < 5; ++i) {
    survey.add(Keyframe{});
    survey.poses.back() = {static_cast<double>(i), 0.0, 0.0};
  }
  for (std::uint32_t i = 0; i < 3; ++i) survey.add({i, i + 1, {1.0, 0.0, 0.0}, diagonal(0.1, 0.01), false});
  return survey;
}

TEST(RelativeCovariance, GrowsAlongTheLinksInBothDirections) {
  const Survey survey = row_of_keyframes();
  const auto from_first = relative_covariances(survey, 0, kAll);
  const auto from_last = relative_covariances(survey, 3, kAll);
  ASSERT_TRUE(from_first[3] && from_last[0]);
  EXPECT_TRUE(from_first[0]->isZero());
  EXPECT_NEAR((*from_first[3])(0, 0), 0.03, 1e-12);
  EXPECT_NEAR((*from_first[3])(2, 2), 0.0003, 1e-12);
  EXPECT_GT((*from_first[3])(1, 1), 0.03) << "headings turn what lies ahead";
  EXPECT_LT((*from_first[3] - inverted_covariance({-3.0, 0.0, 0.0}, *from_last[0])).norm(), 1e-9);
  EXPECT_FALSE(from_first[4]) << "no way leads there";
}

TEST(RelativeCovariance, AnswersWhatIsAskedForInItsOrder) {
  const Survey survey = row_of_keyframes();
  const auto all = relative_covariances(survey, 0, kAll);
  const auto some = relative_covariances(survey, 0, std::array<std::uint32_t, 2>{2, 1});
  ASSERT_EQ(some.size(), 2U);
  EXPECT_EQ(some[0], all[2]);
  EXPECT_EQ(some[1], all[1]);
}

TEST(RelativeCovariance, TakesTheBetterOfTwoWays) {
  Survey survey = row_of_keyframes();
  survey.add({0, 3, {3.0, 0.0, 0.0}, diagonal(0.05, 0.001), true});
  const auto known = relative_covariances(survey, 0, kAll);
  EXPECT_NEAR((*known[3])(0, 0), 0.0025, 1e-12);
  EXPECT_LT((*known[2])(0, 0), 0.0126) << "and from there back";
}

}  // namespace
}  // namespace deltamap::surveying::slam
