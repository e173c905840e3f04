#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Guess: cv::KalmanFilter takes the measurements of two sensors one after the other: one predict(), then correct() with each. The
#   second begins where the first left off, as the equations do: with a prior of 0 +- 1 and two readings of 1 +- 1 the state is 2/3.
# Seen: 1/2. Each correct() starts from the PREDICTED state and covariance, so of all that are given after one predict() only the last
#   counts, and nothing is said. With a predict() of no time in between (transition 1, noise 0) the state is 2/3, with variance 1/3.
# Matters: laser pose and odometry, or two beacons, of one instant: the filter looks as if it fused them and follows just the one
#   that comes last, with a covariance that is too large; a good sensor ahead of a bad one is lost.
# Version: OpenCV 4.6.0 (libopencv-video406 4.6.0+dfsg-12). Source: tracking.hpp says of correct() that it "updates the predicted
#   state from the measurement", and of statePost "corrected state"; nothing limits it to one call.
set -euo pipefail
source "$(dirname "$0")/lib/pinned.bash"

debian_programs libopencv-video406=4.6.0+dfsg-12
debian_files libopencv-core-dev=4.6.0+dfsg-12 libopencv-imgproc-dev=4.6.0+dfsg-12 libopencv-video-dev=4.6.0+dfsg-12
cat > two.cpp << 'CPP'
#include <cstdio>
#include <opencv2/video/tracking.hpp>

void fuse(const char* name, float first, float second, bool is_predicted_between) {
  cv::KalmanFilter filter(1, 1);
  filter.transitionMatrix.setTo(1);
  filter.measurementMatrix.setTo(1);
  filter.processNoiseCov.setTo(0);
  filter.measurementNoiseCov.setTo(1);
  filter.errorCovPost.setTo(1);
  filter.predict();
  filter.correct(cv::Mat(1, 1, CV_32F, cv::Scalar(first)));
  if (is_predicted_between) filter.predict();
  filter.correct(cv::Mat(1, 1, CV_32F, cv::Scalar(second)));
  std::printf("%s %.3f +- %.3f; ", name, filter.statePost.at<float>(0), filter.errorCovPost.at<float>(0));
}

int main() {
  fuse("1 and 1:", 1, 1, false);
  fuse("9 and 1:", 9, 1, false);
  fuse("predicted between:", 1, 1, true);
}
CPP
compiled two.cpp -isystem "$root/usr/include/opencv4" -l:libopencv_video.so.406 -l:libopencv_core.so.406 \
  -Wl,--allow-shlib-undefined
stated 'two readings after 0 +- 1 (variances)' \
  '1 and 1: 0.500 +- 0.500; 9 and 1: 0.500 +- 0.500; predicted between: 0.667 +- 0.333; ' "$(with_libraries ./run)"
