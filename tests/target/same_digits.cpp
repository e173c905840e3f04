// SPDX-License-Identifier: Apache-2.0
// The functions of the C library whose last digits differ between architectures and processors, from plain arithmetic
// that is the same everywhere. Preloaded into a program of either architecture, it leaves only differences that are the
// program's own. Good to some 1e-15, for the moderate arguments of a robot; built by architectures.py for both.
#include <cstdint>
#include <cstring>

namespace {

constexpr double kLn2High = 6.93147180369123816490e-01;  // its last 32 bits are 0: whole multiples are exact
constexpr double kLn2Low = 1.90821492927058770002e-10;
constexpr double kLn10 = 2.302585092994045684;
constexpr double kHalfPiHigh = 1.57079632673412561417;  // the same for pi / 2
constexpr double kHalfPiLow = 6.07710050650619224932e-11;
constexpr double kPi = 3.14159265358979311600;
constexpr double kInfinity = __builtin_huge_val();

double root(double x) { return __builtin_sqrt(x); }
bool is_nan(double x) { return x != x; }
bool is_negative(double x) { return __builtin_signbit(x) != 0; }
double magnitude(double x) { return __builtin_fabs(x); }

/// The nearest whole number, of less than 2^31.
double whole(double x) { return static_cast<double>(static_cast<std::int64_t>(x + (x < 0.0 ? -0.5 : 0.5))); }

/// 2^exponent.
double power_of_two(int exponent) {
  const std::uint64_t bits = static_cast<std::uint64_t>(exponent + 1023) << 52U;
  double power = 0.0;
  std::memcpy(&power, &bits, sizeof power);
  return power;
}

/// sum of x^(first + 2i) with signs that alternate or not, over (first + 2i)! or over first + 2i.
double sine_series(double x) {
  double term = x;
  double sum = x;
  for (int i = 2; i <= 18; i += 2) sum += term *= -x * x / (i * (i + 1.0));
  return sum;
}
double cosine_series(double x) {
  double term = 1.0;
  double sum = 1.0;
  for (int i = 1; i <= 17; i += 2) sum += term *= -x * x / (i * (i + 1.0));
  return sum;
}

struct Turned {
  double rest;  ///< within a quarter of pi
  int quarters;
};
Turned turned(double x) {
  const double count = whole(x / (kPi / 2.0));
  return {(x - count * kHalfPiHigh) - count * kHalfPiLow, static_cast<int>(static_cast<std::int64_t>(count) & 3)};
}

double sine(double x, int shift) {
  if (is_nan(x) || magnitude(x) > 1e9) return __builtin_nan("");
  const Turned t = turned(x);
  const int quarters = (t.quarters + shift) & 3;
  const double value = (quarters & 1) != 0 ? cosine_series(t.rest) : sine_series(t.rest);
  return (quarters & 2) != 0 ? -value : value;
}

double exponential(double x) {
  if (is_nan(x)) return x;
  if (x > 709.7) return kInfinity;
  if (x < -708.0) return 0.0;
  const double count = whole(x / (kLn2High + kLn2Low));
  const double rest = (x - count * kLn2High) - count * kLn2Low;
  double term = 1.0;
  double sum = 1.0;
  for (int i = 1; i <= 15; ++i) sum += term *= rest / i;
  const int half = static_cast<int>(count) / 2;
  return sum * power_of_two(half) * power_of_two(static_cast<int>(count) - half);
}

double logarithm(double x) {
  if (is_nan(x) || x < 0.0) return __builtin_nan("");
  if (x == 0.0) return -kInfinity;
  if (x == kInfinity) return x;
  int exponent = 0;
  for (; x > 1.5; ++exponent) x *= 0.5;
  for (; x < 0.75; --exponent) x *= 2.0;
  const double s = (x - 1.0) / (x + 1.0);
  double power = s;
  double sum = 0.0;
  for (int i = 1; i <= 27; i += 2, power *= s * s) sum += power / i;
  return exponent * kLn2High + (2.0 * sum + exponent * kLn2Low);
}

/// Of 0 to 1.
double arc_tangent(double t) {
  for (int i = 0; i < 2; ++i) t /= 1.0 + root(1.0 + t * t);  // half the angle
  double power = t;
  double sum = 0.0;
  for (int i = 1; i <= 25; i += 2, power *= -t * t) sum += power / i;
  return 4.0 * sum;
}

double angle(double y, double x) {
  if (is_nan(x) || is_nan(y)) return __builtin_nan("");
  const double high = magnitude(y);
  const double wide = magnitude(x);
  double found = 0.0;
  if (high > wide) {
    found = kPi / 2.0 - arc_tangent(wide / high);
  } else if (wide > 0.0) {
    found = wide == kInfinity && high == kInfinity ? kPi / 4.0 : arc_tangent(high / wide);
  }
  if (is_negative(x)) found = kPi - found;
  return is_negative(y) ? -found : found;
}

double power(double x, double y) {
  const double count = whole(y);
  if (count == y && magnitude(y) <= 64.0) {
    double product = 1.0;
    for (int i = 0; i < static_cast<int>(magnitude(y)); ++i) product *= x;
    return y < 0.0 ? 1.0 / product : product;
  }
  return x == 0.0 ? 0.0 : exponential(y * logarithm(x));
}

}  // namespace

extern "C" {
double sin(double x) { return sine(x, 0); }
double cos(double x) { return sine(x, 1); }
void sincos(double x, double* s, double* c) {
  *s = sine(x, 0);
  *c = sine(x, 1);
}
void sincosf(float x, float* s, float* c) {
  *s = static_cast<float>(sine(x, 0));
  *c = static_cast<float>(sine(x, 1));
}
double exp(double x) { return exponential(x); }
double exp2(double x) { return exponential(x * (kLn2High + kLn2Low)); }
double log(double x) { return logarithm(x); }
double log10(double x) { return logarithm(x) / kLn10; }
double pow(double x, double y) { return power(x, y); }
double atan2(double y, double x) { return angle(y, x); }
double asin(double x) { return angle(x, root((1.0 - x) * (1.0 + x))); }
double acos(double x) { return angle(root((1.0 - x) * (1.0 + x)), x); }
double hypot(double x, double y) { return root(x * x + y * y); }
float hypotf(float x, float y) {
  return static_cast<float>(root(static_cast<double>(x) * x + static_cast<double>(y) * y));
}
}
