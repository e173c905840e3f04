#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Guess: OpenCV's imread scales a PGM by the maximum in its header, in its binary (P5) form as in its text form (P2): the
#   same map gives the same grey.
# Seen: P2 is scaled to 0..255, P5 is not: of a map with maximum 100, white reads 255 in one and 100 in the other. Read as
#   8-bit grey, a P5 of 16 bit with maximum 1000 is black but for 0 to 3, white included. Pillow scales both.
# Matters: a map whose white is 100 (grids of 0..100 written as they are) has no free cell left, as 100 of 255 is below every
#   free threshold: the planner finds no way, and conversion to text "repairs" it.
# Version: OpenCV 4.6.0 (4.6.0+dfsg-12), Pillow 9.4.0 (9.4.0-1.1+deb12u1). Source: netpbm's pgm(5): grey is proportional, with
#   the maximum as white; OpenCV's grfmt_pxm.cpp scales by a table in the text branch and copies in the binary one.
set -euo pipefail
source "$(dirname "$0")/lib/pinned.bash"

debian_programs libopencv-imgcodecs406=4.6.0+dfsg-12 python3-pil=9.4.0-1.1+deb12u1
debian_files libopencv-core-dev=4.6.0+dfsg-12 libopencv-imgcodecs-dev=4.6.0+dfsg-12
cat > grey.cpp << 'CPP'
#include <iostream>
#include <opencv2/imgcodecs.hpp>

int main(int, char** files) {
  const cv::Mat grey = cv::imread(files[1], cv::IMREAD_GRAYSCALE);
  for (int x = 0; x < grey.cols; ++x) std::cout << int{grey.at<unsigned char>(0, x)} << ' ';
}
CPP
compiled grey.cpp -isystem "$root/usr/include/opencv4" -l:libopencv_imgcodecs.so.406 -l:libopencv_core.so.406 \
  -Wl,--allow-shlib-undefined
opencv() { with_libraries ./run "$1"; }
pillow() {
  PYTHONPATH=$root/usr/lib/python3/dist-packages with_libraries /usr/bin/python3 -c \
    "import sys; from PIL import Image; print(*Image.open(sys.argv[1]).getdata())" "$1"
}
printf 'P2\n4 1\n100\n0 20 80 100\n' > text.pgm
printf 'P5\n4 1\n100\n\x00\x14\x50\x64' > binary.pgm
printf 'P5\n4 1\n1000\n\x00\x00\x00\xc8\x03\x20\x03\xe8' > deep.pgm
stated 'OpenCV, 0 20 80 100 of 100 as text' '0 51 204 255 ' "$(opencv text.pgm)"
stated 'OpenCV, the same in binary' '0 20 80 100 ' "$(opencv binary.pgm)"
stated 'OpenCV, 0 200 800 1000 of 1000 in binary' '0 0 3 3 ' "$(opencv deep.pgm)"
stated 'Pillow, text and binary' '0 51 204 255, 0 51 204 255' "$(pillow text.pgm), $(pillow binary.pgm)"
