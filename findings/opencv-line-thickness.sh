#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Guess: OpenCV's line of thickness 3 along a row of cells is 3 cells wide, and fillPoly of a square with its corners in cells 5 and
#   15 fills as many cells as contourArea says, 100.
# Seen: thickness 1 to 6 gives 1, 3, 5, 5, 7, 7 cells, and the line is longer than from end to end by as much as it is wider than
#   one cell. The square has 121 cells: its outline is drawn as well, and the area is that between the cells' centres.
# Matters: a virtual wall or a keep-out mask that is drawn so closes 25 cm where 15 were meant, at 5 cm a cell, and two of them the
#   passage between; areas of contours and counts of cells never agree. Fill a rectangle of cells where the width counts.
# Version: OpenCV 4.6.0 (libopencv-imgproc406 4.6.0+dfsg-12). Source: imgproc.hpp says "line thickness" and no more; opencv's issue
#   15604 asks what it means, and shows other surprises of that kind.
set -euo pipefail
source "$(dirname "$0")/lib/pinned.bash"

debian_programs libopencv-imgproc406=4.6.0+dfsg-12
debian_files libopencv-core-dev=4.6.0+dfsg-12 libopencv-imgproc-dev=4.6.0+dfsg-12
cat > walls.cpp << 'CPP'
#include <iostream>
#include <opencv2/imgproc.hpp>
#include <vector>

int main() {
  for (int thickness = 1; thickness <= 6; ++thickness) {
    cv::Mat map = cv::Mat::zeros(40, 60, CV_8U);
    cv::line(map, {20, 20}, {40, 20}, 255, thickness);
    std::cout << cv::countNonZero(map.col(30)) << " by " << cv::countNonZero(map.row(20)) << ", ";
  }
  const std::vector<cv::Point> square{{5, 5}, {15, 5}, {15, 15}, {5, 15}};
  cv::Mat map = cv::Mat::zeros(40, 60, CV_8U);
  cv::fillPoly(map, std::vector<std::vector<cv::Point>>{square}, 255);
  std::cout << "square " << cv::countNonZero(map) << " of " << cv::contourArea(square);
}
CPP
compiled walls.cpp -isystem "$root/usr/include/opencv4" -l:libopencv_imgproc.so.406 -l:libopencv_core.so.406 \
  -Wl,--allow-shlib-undefined
expected='1 by 21, 3 by 23, 5 by 25, 5 by 25, 7 by 27, 7 by 27, square 121 of 100'
stated 'lines from 20 to 40 of thickness 1 to 6' "$expected" "$(with_libraries ./run)"
