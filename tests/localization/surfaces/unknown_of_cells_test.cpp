// SPDX-License-Identifier: Apache-2.0
// What the cells of a map leave open of a pose, by how its surfaces stand off them.
#include "localization/surfaces/unknown_of_cells.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace deltamap::localization::surfaces {
namespace {

constexpr double kCell_m = 0.029;  // deviation of one surface: cells of 0.1 m
constexpr double kCell_m2 = kCell_m * kCell_m;

class Walls : public testing::Test {
 protected:
  /// Walls that face `normal`, one for each offset.
  void stand(const Point2& normal, const std::vector<double>& offsets_m) {
    for (const double offset_m : offsets_m) {
      faces.push_back({.normal = normal, .cells_m = kCell_m, .off_m = offset_m});
    }
  }
  [[nodiscard]] Eigen::Matrix2d unknown() const {
    const UnknownOfCells both = unknown_of_cells(faces);
    return both.scattered + both.alike;
  }

  std::vector<SupportingFace> faces;
};

const std::vector<double> kScattered{-0.04, -0.03, -0.02, 0.0, 0.02, 0.03, 0.04, 0.0};
const Point2 kAlongX{1.0, 0.0};
const Point2 kAlongY{0.0, 1.0};

TEST_F(Walls, AverageOutWhereEachStandsOffInItsOwnWay) {
  stand(kAlongX, kScattered);
  stand(kAlongY, kScattered);
  EXPECT_NEAR(unknown()(0, 0), kCell_m2 / 8.0, 0.3 * kCell_m2 / 8.0);
  EXPECT_NEAR(unknown()(1, 1), kCell_m2 / 8.0, 0.3 * kCell_m2 / 8.0);
}

TEST_F(Walls, AreOneObservationWhereAllStandOffAlike) {
  stand(kAlongX, std::vector<double>(8, 0.03));
  stand(kAlongY, std::vector<double>(8, -0.02));
  EXPECT_GT(unknown()(0, 0), 0.8 * kCell_m2);
  EXPECT_GT(unknown()(1, 1), 0.8 * kCell_m2);
  EXPECT_LE(unknown()(0, 0), kCell_m2);
  EXPECT_NEAR(unknown_of_cells(faces).scattered(0, 0), kCell_m2 / 8.0, 1e-9);
}

TEST_F(Walls, LeaveMoreOpenInAMapThatIsDrawnWorseThanItsCells) {
  std::vector<double> ragged = kScattered;
  for (double& offset_m : ragged) offset_m *= 3.0;
  stand(kAlongX, ragged);
  stand(kAlongY, ragged);
  EXPECT_GT(unknown()(0, 0), 4.0 * kCell_m2 / 8.0);
}

TEST_F(Walls, TellNothingMoreThanOneOfTheirOwnDirection) {
  stand(kAlongX, {0.01});
  EXPECT_NEAR(unknown()(0, 0), kCell_m2, 1e-12);
  stand(kAlongY, kScattered);
  EXPECT_GT(unknown()(0, 0), 0.999 * kCell_m2);
  EXPECT_LT(unknown()(1, 1), 0.5 * kCell_m2);
}

TEST_F(Walls, DoNotCountWhereTheyWereMoved) {
  stand(kAlongX, kScattered);
  stand(kAlongY, kScattered);
  const double before_m2 = unknown()(0, 0);
  stand(kAlongX, {0.4, -0.5, 0.6});
  for (std::size_t i = faces.size() - 3; i < faces.size(); ++i) faces[i].weight = 0.0;
  EXPECT_NEAR(unknown()(0, 0), before_m2, 1e-12);
}

TEST_F(Walls, LeaveNothingOpenWhereNoneIsFollowed) { EXPECT_TRUE(unknown().isZero()); }

}  // namespace
}  // namespace deltamap::localization::surfaces
