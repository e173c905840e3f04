// SPDX-License-Identifier: Apache-2.0
#include "localization/surfaces/surface_switch.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace deltamap::localization::surfaces {
namespace {

constexpr int kSweeps = 3;
constexpr double kDamping = 0.7;   // share of a change that is made at once
constexpr double kSettled = 1e-3;  // a smaller change, as a share, is none
constexpr double kSurestOdds = 30.0;
constexpr double kSameOffsetM = 0.05;  // between their offsets

/// An offset and turn as they would be known without the surface's own switch.
struct Cavity {
  Eigen::Vector2d mean;
  Eigen::Matrix2d covariance;
  bool is_proper = false;
};

Cavity cavity_of(const SurfaceSwitch& of, const OffsetState& state, Eigen::Index at) {
  const Eigen::Matrix2d known = state.covariance_at<2>(at).inverse();
  const Eigen::Matrix2d without = known - of.precision;
  Cavity cavity;
  cavity.is_proper = without(0, 0) > 0.0 && without.determinant() > 0.0;
  if (!cavity.is_proper) return cavity;
  cavity.covariance = without.inverse();
  cavity.mean = cavity.covariance * (known * state.mean().segment<2>(at) - of.pull);
  return cavity;
}

/// Precision of a surface that holds, beyond that of one that was moved.
Eigen::Vector2d precision_of_holding(const Surface& surface) {
  const auto beyond = [](double held, double moved) {
    const double least = std::min(held, 0.5 * moved);
    return 1.0 / (least * least) - 1.0 / (moved * moved);
  };
  return {beyond(surface.offset_deviation_m, sensor::kMovedM), beyond(surface.turn_deviation_rad, kMovedRad)};
}

/// ln of P(holds) / P(was moved), by the evidence at the cavity.
double log_odds(const SurfaceSwitch& of, const Cavity& cavity) {
  const Eigen::Vector2d precision = precision_of_holding(of.surface);
  const Eigen::Vector2d off = cavity.mean - Eigen::Vector2d{of.usual_m, 0.0};
  const Eigen::Matrix2d expected = cavity.covariance + precision.cwiseInverse().asDiagonal().toDenseMatrix();
  const double narrower =
      (1.0 + precision[0] * sensor::kMovedM * sensor::kMovedM) * (1.0 + precision[1] * kMovedRad * kMovedRad);
  const double wider = precision[0] * precision[1] * expected.determinant();
  return std::log(of.prior / (1.0 - of.prior)) + 0.5 * std::log(narrower / wider) -
         0.5 * off.dot(expected.inverse() * off);
}

bool stand_off_alike(const OffsetState& state, std::size_t a, std::size_t b) {
  const Eigen::Index i = OffsetState::offset_of(a);
  const Eigen::Index k = OffsetState::offset_of(b);
  const double deviation_m =
      std::sqrt(std::max(0.0, state.covariance(i, i) + state.covariance(k, k) - 2.0 * state.covariance(i, k)));
  return std::abs(state.mean()[i] - state.mean()[k]) < kSameOffsetM + 2.0 * deviation_m;
}

/// Moment matching: the two cases, weighed, as one Gaussian; less the cavity that is what the switch adds. Where it
/// would take precision away the switch says nothing.
void match(SurfaceSwitch& of, const Cavity& cavity, OffsetState& state, Eigen::Index at) {
  const Eigen::Matrix2d known = cavity.covariance.inverse();
  const Eigen::Matrix2d hold = (of.share * precision_of_holding(of.surface)).asDiagonal();
  const Eigen::Matrix2d covariance_held = (known + hold).inverse();
  const Eigen::Vector2d mean_held = covariance_held * (known * cavity.mean + hold * Eigen::Vector2d{of.usual_m, 0.0});
  const double w = of.holds;
  const Eigen::Vector2d apart = mean_held - cavity.mean;
  const Eigen::Vector2d mean = cavity.mean + w * apart;
  const Eigen::Matrix2d precision =
      (w * covariance_held + (1.0 - w) * cavity.covariance + w * (1.0 - w) * apart * apart.transpose()).inverse();
  Eigen::Matrix2d added = precision - known;
  Eigen::Vector2d pull = precision * mean - known * cavity.mean;
  if (added(0, 0) < 0.0 || added(1, 1) < 0.0 || added.determinant() < 0.0) {
    added.setZero();
    pull.setZero();
  }
  const Eigen::Matrix2d change = kDamping * (added - of.precision);
  const Eigen::Vector2d change_of_pull = kDamping * (pull - of.pull);
  if (change.norm() < kSettled * (1.0 + of.precision.norm()) &&
      change_of_pull.norm() < kSettled * (1.0 + of.pull.norm()))
    return;
  state.multiply<2>(at, change, change_of_pull);
  of.precision += change;
  of.pull += change_of_pull;
}

}  // namespace

void settle(std::vector<SurfaceSwitch>& switches, OffsetState& state) {
  const std::vector<std::size_t> body = bodies(switches.size(), [&](std::size_t a, std::size_t b) {
    return are_one_face(switches[a].surface, switches[b].surface) && stand_off_alike(state, a, b);
  });
  std::vector<Cavity> cavities(switches.size());
  const auto look = [&](std::size_t i) { cavities[i] = cavity_of(switches[i], state, OffsetState::offset_of(i)); };
  for (std::size_t i = 0; i < switches.size(); ++i) {
    look(i);
    switches[i].share = 1.0 / static_cast<double>(std::count(body.begin(), body.end(), body[i]));
  }
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (std::size_t i = 0; i < switches.size(); ++i) {
      look(i);
      if (!cavities[i].is_proper) continue;
      // One observation for a body: the piece that is known best speaks for all.
      std::size_t speaker = i;
      for (std::size_t k = 0; k < switches.size(); ++k) {
        const bool speaks = body[k] == body[i] && cavities[k].is_proper;
        if (speaks && cavities[k].covariance(0, 0) < cavities[speaker].covariance(0, 0)) speaker = k;
      }
      const double odds = log_odds(switches[speaker], cavities[speaker]);
      switches[i].holds = 1.0 / (1.0 + std::exp(-std::clamp(odds, -kSurestOdds, kSurestOdds)));
      match(switches[i], cavities[i], state, OffsetState::offset_of(i));
    }
  }
}

}  // namespace deltamap::localization::surfaces
