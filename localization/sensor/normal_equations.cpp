// SPDX-License-Identifier: Apache-2.0
// Single precision suffices: a cell of a map 200 m wide is told apart to a four-thousandth. The vector types are GCC's
// and Clang's; a processor without SSE2 takes the lanes one after the other and finds the same sums.
#include "localization/sensor/normal_equations.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

namespace deltamap::localization::sensor {
namespace {

constexpr std::size_t kLanes = 4;
using Floats = float __attribute__((vector_size(16)));
using Ints = std::int32_t __attribute__((vector_size(16)));

Floats all(float value) { return Floats{value, value, value, value}; }

float sum(Floats lanes) { return (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]); }

Floats four_of(const float* values) {
  Floats lanes;
  std::memcpy(&lanes, values, sizeof(lanes));
  return lanes;
}

/// Those after the last whole four, the missing ones 0.
Floats rest_of(const std::vector<float>& values) {
  Floats lanes{};
  for (std::size_t i = 0; i < values.size() % kLanes; ++i)
    lanes[i] = values[values.size() - values.size() % kLanes + i];
  return lanes;
}

/// e^x for x <= 0, to a few millionths: 2^whole by the exponent's bits, the rest by its series.
Floats exp_of(Floats x) {
  constexpr float kLog2E = 1.44269504F;
  constexpr float kLn2 = 0.693147181F;
  const Floats in_twos = (x > -87.0F ? x : all(-87.0F)) * kLog2E;
  const Ints whole = __builtin_convertvector(in_twos - 0.5F, Ints);  // to the nearest
  const Floats r = (in_twos - __builtin_convertvector(whole, Floats)) * kLn2;
  const Floats series = 1.0F + r * (1.0F + r * (0.5F + r * (1.0F / 6.0F + r * (1.0F / 24.0F + r * (1.0F / 120.0F)))));
  const Ints bits = (whole + 127) << 23;
  Floats power;
  std::memcpy(&power, &bits, sizeof(power));
  return power * series;
}

/// Distances of the four centres around each of four points, and where the point lies between them.
struct Around {
  Floats low_left, low_right, high_left, high_right;  // m
  Floats u, v;                                        // from left to right, from low to high: 0..1
  Ints inside;                                        // all bits: the point lies in the map
};

Around around(const LikelihoodField& field, Floats x_wanted, Floats y_wanted) {
  const LikelihoodField::Bordered bordered = field.bordered();
  const float most_x = static_cast<float>(bordered.width) - 1.01F;
  const float most_y = static_cast<float>(bordered.height) - 1.01F;
  const Ints inside = (x_wanted >= 0.0F) & (x_wanted <= most_x) & (y_wanted >= 0.0F) & (y_wanted <= most_y);
  const Floats x = inside ? x_wanted : all(0.0F);
  const Floats y = inside ? y_wanted : all(0.0F);
  const Ints column = __builtin_convertvector(x, Ints);
  const Ints row = __builtin_convertvector(y, Ints);
  const Ints cell = row * bordered.width + column;
  Around at;
  at.u = x - __builtin_convertvector(column, Floats);
  at.v = y - __builtin_convertvector(row, Floats);
  at.inside = inside;
  const std::array<float, 256>& distance = field.distance_of_steps_m();
  const auto four_at = [&](std::ptrdiff_t beside) {
    const std::uint8_t* const from = bordered.bytes + beside;
    return Floats{distance[from[cell[0]]], distance[from[cell[1]]], distance[from[cell[2]]], distance[from[cell[3]]]};
  };
  at.low_left = four_at(0);
  at.low_right = four_at(1);
  at.high_left = four_at(bordered.width);
  at.high_right = four_at(bordered.width + 1);
  return at;
}

struct Sums {
  Floats xx{}, xy{}, xt{}, yy{}, yt{}, tt{};  // w JᵀJ
  Floats x{}, y{}, t{};                       // w Jᵀd
  Floats explained{}, squares_m2{};

  /// Four beams: ends as seen from the robot in the map's directions.
  void add(const Around& at, Floats dx_m, Floats dy_m, float cells_per_m, float per_variance, float random_share) {
    const Floats along_low = at.low_right - at.low_left;
    const Floats along_high = at.high_right - at.high_left;
    const Floats low = at.low_left + at.u * along_low;
    const Floats up = at.high_left + at.u * along_high - low;
    const Floats distance_m = low + at.v * up;
    const Floats jx = (along_low + at.v * (along_high - along_low)) * cells_per_m;
    const Floats jy = up * cells_per_m;
    const Floats jt = jy * dx_m - jx * dy_m;
    const Ints pulls = at.inside & ((jx != 0.0F) | (jy != 0.0F));
    const Floats hit = (1.0F - random_share) * exp_of(-0.5F * per_variance * distance_m * distance_m);
    const Floats w = pulls ? hit / (hit + random_share) : all(0.0F);
    const Floats wd = w * distance_m;
    xx += w * jx * jx;
    xy += w * jx * jy;
    xt += w * jx * jt;
    yy += w * jy * jy;
    yt += w * jy * jt;
    tt += w * jt * jt;
    x += wd * jx;
    y += wd * jy;
    t += wd * jt;
    explained += w;
    squares_m2 += wd * distance_m;
  }
};

}  // namespace

NormalEquations normal_equations(const LikelihoodField& field, const motion::BeamEnds& ends,
                                 const Pose2& map_from_robot) {
  const double per_variance = 1.0 / (field.hit_deviation_m() * field.hit_deviation_m());
  const double cells_per_m = 1.0 / field.geometry().resolution_m;
  const auto scale = static_cast<float>(cells_per_m);
  // In the bordered field the centre of cell (0, 0) lies at (1.5, 1.5); centres are the knots.
  const Point2 origin = field.bordered().origin;
  const auto x_cells = static_cast<float>((map_from_robot.x - origin.x()) * cells_per_m + 0.5);
  const auto y_cells = static_cast<float>((map_from_robot.y - origin.y()) * cells_per_m + 0.5);
  const auto c = static_cast<float>(std::cos(map_from_robot.theta));
  const auto s = static_cast<float>(std::sin(map_from_robot.theta));
  Sums of;
  const auto add = [&](Floats x_m, Floats y_m, Ints counted) {
    const Floats dx_m = c * x_m - s * y_m;
    const Floats dy_m = s * x_m + c * y_m;
    Around at = around(field, x_cells + dx_m * scale, y_cells + dy_m * scale);
    at.inside &= counted;
    of.add(at, dx_m, dy_m, scale, static_cast<float>(per_variance), static_cast<float>(field.params().random_share));
  };
  const std::size_t rest = ends.size() % kLanes;
  for (std::size_t first = 0; first + rest < ends.size(); first += kLanes) {
    add(four_of(ends.x_m.data() + first), four_of(ends.y_m.data() + first), Ints{-1, -1, -1, -1});
  }
  if (rest > 0) add(rest_of(ends.x_m), rest_of(ends.y_m), Ints{-1, rest > 1 ? -1 : 0, rest > 2 ? -1 : 0, 0});
  NormalEquations sums;
  sums.information << sum(of.xx), sum(of.xy), sum(of.xt), sum(of.xy), sum(of.yy), sum(of.yt), sum(of.xt), sum(of.yt),
      sum(of.tt);
  sums.pull << sum(of.x), sum(of.y), sum(of.t);
  sums.information *= per_variance;
  sums.pull *= per_variance;
  sums.explained = static_cast<double>(sum(of.explained));
  sums.squares_m2 = static_cast<double>(sum(of.squares_m2));
  return sums;
}

}  // namespace deltamap::localization::sensor
