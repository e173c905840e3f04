// SPDX-License-Identifier: Apache-2.0
// What lines, letters and signs are drawn on. x to the right, y down, in pixels; what reaches beyond the edge is cut
// off.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tool/picture/ink.hpp"
#include "tool/picture/raster.hpp"

namespace deltamap::tool::picture {

struct Pixel {
  double x = 0.0;
  double y = 0.0;
};

class Canvas {
 public:
  Canvas(int width, int height, const Ink& paper);
  ~Canvas();
  Canvas(Canvas&&) noexcept;
  Canvas& operator=(Canvas&&) noexcept;

  [[nodiscard]] int width() const;
  [[nodiscard]] int height() const;

  void fill(int left, int top, int width, int height, const Ink& ink);
  void draw_line(const std::vector<Pixel>& points, const Ink& ink, int thickness = 2);
  void draw_disc(Pixel middle, int radius, const Ink& ink);
  void draw_ring(Pixel middle, int radius);  ///< round a small change
  void draw_robot(Pixel middle, double heading_rad, double radius);
  void draw_text(const std::string& text, int left, int base);
  [[nodiscard]] static int text_width(const std::string& text);
  /// Lays the upper `rows` rows of another one over this one.
  void paste(const Canvas& other, int left, int top, int rows);

  [[nodiscard]] Raster raster() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace deltamap::tool::picture
