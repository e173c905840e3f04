#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Guess: OpenCV's matchTemplate() by TM_CCOEFF_NORMED, which is a correlation, gives a template without any structure, such as a patch of
#   free or unknown cells, no score anywhere: it correlates with nothing, 0 by 0.
# Seen: 1, the score of a perfect match, in every place, walls among them. By TM_CCORR_NORMED a template of all zeros scores 0
#   everywhere. The other way round a patch of the map without structure scores 0 for any template, as guessed.
# Matters: a place that is looked up in the map by the patch around the robot: in the middle of a hall, or with a laser that
#   sees nothing, the answer is the upper left corner of the map at a certainty of 100 %, and all thresholds let it pass. Look
#   at the template's spread first.
# Version: OpenCV 4.6.0 (libopencv-imgproc406 4.6.0+dfsg-12). Source: imgproc.hpp gives the formula of TM_CCOEFF_NORMED, whose numerator and
#   denominator are 0 here, and says nothing of that.
set -euo pipefail
source "$(dirname "$0")/lib/pinned.bash"

debian_programs libopencv-imgproc406=4.6.0+dfsg-12
debian_files libopencv-core-dev=4.6.0+dfsg-12 libopencv-imgproc-dev=4.6.0+dfsg-12
cat > template.cpp << 'CPP'
#include <cstdio>
#include <opencv2/imgproc.hpp>

int main() {
  cv::Mat map(100, 100, CV_8U, cv::Scalar(205));
  cv::rectangle(map, {10, 10, 80, 80}, 254, -1);
  cv::rectangle(map, {10, 10, 80, 80}, 0, 1);
  const auto scored = [&](const char* name, const cv::Mat& patch, int method) {
    cv::Mat scores;
    cv::matchTemplate(map, patch, scores, method);
    double least = 0, most = 0;
    cv::Point best;
    cv::minMaxLoc(scores, &least, &most, nullptr, &best);
    std::printf("%s %.2f to %.2f at %d %d; ", name, least, most, best.x, best.y);
  };
  scored("free", map({40, 40, 12, 12}), cv::TM_CCOEFF_NORMED);
  scored("unknown", map({0, 0, 8, 8}), cv::TM_CCOEFF_NORMED);
  scored("zeros by CCORR", cv::Mat::zeros(12, 12, CV_8U), cv::TM_CCORR_NORMED);
  cv::Mat scores;
  cv::matchTemplate(map, map({5, 5, 12, 12}), scores, cv::TM_CCOEFF_NORMED);
  std::printf("a corner: there %.2f, in the free %.2f", scores.at<float>(5, 5), scores.at<float>(40, 40));
}
CPP
compiled template.cpp -isystem "$root/usr/include/opencv4" -l:libopencv_imgproc.so.406 -l:libopencv_core.so.406 \
  -Wl,--allow-shlib-undefined
expected='free 1.00 to 1.00 at 0 0; unknown 1.00 to 1.00 at 0 0; zeros by CCORR 0.00 to 0.00 at 0 0; a corner: there 1.00, in the free 0.00'
stated 'scores' "$expected" "$(with_libraries ./run)"
