#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Guess: OpenCV's phaseCorrelate() of two cut-outs of a map finds the shift between them to a fraction of a cell, whatever
#   their size: it pads them to a size that suits its Fourier transform, and tells the shift from the middle.
# Seen: half a cell is added to both axes where the padded size is odd: a map against itself is shifted by (0.5, 0.5). Of cut-outs of 124
#   cells, padded to 125, that are shifted by (7, 3) it finds (7.5, 3.5), of 128 (7.0, 3.0). With a window it is the
#   same. The response is as high as for the right ones. Padded sizes of 45, 75, 81, 125, 135, 225, 243 and 375 are such.
# Matters: matching local maps, or the drift between two surveys: 2.5 cm at cells of 5 cm, always in one direction, which adds up from
#   match to match, and comes and goes with the size of the cut-out. Cut out even getOptimalDFTSize().
# Version: OpenCV 4.6.0 (libopencv-imgproc406 4.6.0+dfsg-12). Source: imgproc.hpp, phaseCorrelate: "sub-pixel accuracy", pads with
#   getOptimalDFTSize, and the shift is from the middle of the peak to the middle of the image.
set -euo pipefail
source "$(dirname "$0")/lib/pinned.bash"

debian_programs libopencv-imgproc406=4.6.0+dfsg-12
debian_files libopencv-core-dev=4.6.0+dfsg-12 libopencv-imgproc-dev=4.6.0+dfsg-12
cat > shift.cpp << 'CPP'
#include <cmath>
#include <cstdio>
#include <opencv2/imgproc.hpp>

int main() {
  cv::Mat hall = cv::Mat::zeros(400, 400, CV_32F);
  cv::RNG random(3);
  for (int wall = 0; wall < 60; ++wall) {
    const int along = random.uniform(10, 60);
    const bool is_upright = wall % 2 == 0;
    cv::rectangle(hall, {random.uniform(0, 330), random.uniform(0, 330), is_upright ? 2 : along, is_upright ? along : 2}, 1, -1);
  }
  for (const int size : {120, 124, 128, 132}) {
    const cv::Mat first = hall({100, 100, size, size}).clone(), second = hall({93, 97, size, size}).clone();
    cv::Mat window;
    cv::createHanningWindow(window, {size, size}, CV_32F);
    const auto half = [](double cells) { return std::round(2 * cells) / 2 + 0.0; };
    const cv::Point2d same = cv::phaseCorrelate(first, first, window), moved = cv::phaseCorrelate(first, second, window);
    std::printf("%d as %d: %.1f %.1f, %.1f %.1f; ", size, cv::getOptimalDFTSize(size), half(same.x), half(same.y), half(moved.x),
                half(moved.y));
  }
}
CPP
compiled shift.cpp -isystem "$root/usr/include/opencv4" -l:libopencv_imgproc.so.406 -l:libopencv_core.so.406 \
  -Wl,--allow-shlib-undefined
expected='120 as 120: 0.0 0.0, 7.0 3.0; 124 as 125: 0.5 0.5, 7.5 3.5; 128 as 128: 0.0 0.0, 7.0 3.0; 132 as 135: 0.5 0.5, 7.5 3.5; '
stated 'cells of shift, of none and of 7 and 3' "$expected" "$(with_libraries ./run)"
