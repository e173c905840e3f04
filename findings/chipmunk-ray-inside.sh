#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Guess: a ray that starts inside a shape hits it at once: both 2-D physics libraries of Debian report a hit of length 0
#   at the start, as a laser that is buried in an obstacle reads 0.
# Seen: they disagree with the guess and with each other. Box2D passes through and reports nothing. Chipmunk reports a hit
#   with alpha 0 whose point is the END of the ray, so range by alpha is 0 and range by point is the full length.
# Matters: a simulated laser inside the robot's own hull (or a robot pushed into a wall) sees freely out of it with one
#   library, and with the other 0 or the maximum range, by which of two fields the simulator reads.
# Version: Box2D 2.4.1 (libbox2d2 2.4.1-3), Chipmunk 7.0.3 (libchipmunk7 7.0.3-5). Source: cpSegmentQueryInfo in
#   cpShape.h calls point the point of impact; Box2D's manual says that shapes do not report rays from inside.
set -euo pipefail
source "$(dirname "$0")/lib/pinned.bash"

debian_programs libbox2d2=2.4.1-3 libchipmunk7=7.0.3-5
debian_files libbox2d-dev=2.4.1-3 libchipmunk-dev=7.0.3-5
cat > inside.cpp << 'CPP'
#include <box2d/box2d.h>
#include <chipmunk/chipmunk.h>

#include <cstdio>
#include <initializer_list>

struct Nearest : b2RayCastCallback {
  float fraction = -1.0f;
  float ReportFixture(b2Fixture*, const b2Vec2&, const b2Vec2&, float hit) override { return fraction = hit; }
};

// A square of 2 m round the origin; rays along x.
int main() {
  b2World world({0, 0});
  b2BodyDef fixed;
  b2PolygonShape square;
  square.SetAsBox(1, 1);
  world.CreateBody(&fixed)->CreateFixture(&square, 0);
  cpSpace* space = cpSpaceNew();
  cpSpaceAddShape(space, cpBoxShapeNew2(cpSpaceGetStaticBody(space), cpBBNew(-1, -1, 1, 1), 0));
  for (const float from : {-3.0f, 0.0f}) {
    Nearest box2d;
    world.RayCast(&box2d, {from, 0}, {3, 0});
    cpSegmentQueryInfo hit;
    const bool is_hit = cpSpaceSegmentQueryFirst(space, cpv(from, 0), cpv(3, 0), 0, CP_SHAPE_FILTER_ALL, &hit) != nullptr;
    std::printf("from %g: box2d %.3f, chipmunk hit %d alpha %.3f point %.3f; ", from, box2d.fraction, is_hit, hit.alpha,
                hit.point.x);
  }
}
CPP
compiled inside.cpp -l:libbox2d.so.2 -l:libchipmunk.so.7
stated 'rays to x = 3' \
  'from -3: box2d 0.333, chipmunk hit 1 alpha 0.333 point -1.000; from 0: box2d -1.000, chipmunk hit 1 alpha 0.000 point 3.000; ' \
  "$(with_libraries ./run | tail -n 1)"
