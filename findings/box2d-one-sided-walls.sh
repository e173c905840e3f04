#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Guess: of Box2D's one-sided walls a laser and a robot agree which side is solid: what stops the one stops the other.
# Seen: rays hit the segments of a chain from both sides, bodies are stopped by one. A room of 4 x 4 m that is drawn counterclockwise is
#   measured right from within, 2 m in each direction, and a robot drives through its wall; drawn clockwise it is
#   kept in, and one from outside drives in through a wall that its laser saw. A segment that is made one-sided by
#   SetOneSided(), with the same neighbours, is not seen from behind by rays either.
# Matters: a simulated site whose outlines come from a drawing has both directions of winding: every scan is right, and a
#   planner that fails shows no collision. Test the walls with bodies, not with the laser.
# Version: Box2D 2.4.1 (libbox2d2 2.4.1-3). Source: b2_chain_shape.h: "the chain has one-sided collision", with the normal to the right
#   of each edge; b2_edge_shape.h: neighbours make "the collision one-sided". Neither speaks of rays.
set -euo pipefail
source "$(dirname "$0")/lib/pinned.bash"

debian_programs libbox2d2=2.4.1-3
debian_files libbox2d-dev=2.4.1-3
cat > room.cpp << 'CPP'
#include <box2d/box2d.h>

#include <cstdio>

struct Nearest : b2RayCastCallback {
  float fraction = -0.1f;
  float ReportFixture(b2Fixture*, const b2Vec2&, const b2Vec2&, float hit) override { return fraction = hit; }
};

float range(const b2World& world, b2Vec2 from, b2Vec2 to) {  // over 10 m; -1: nothing
  Nearest nearest;
  world.RayCast(&nearest, from, to);
  return 10 * nearest.fraction;
}

b2Body* robot(b2World& world, float x) {
  b2BodyDef moving;
  moving.type = b2_dynamicBody;
  moving.position = {x, 0};
  b2CircleShape hull;
  hull.m_radius = 0.3f;
  b2Body* body = world.CreateBody(&moving);
  body->CreateFixture(&hull, 1);
  return body;
}

void look_and_drive(const char* name, const b2Shape& walls) {
  b2World world({0, 0});
  b2BodyDef fixed;
  world.CreateBody(&fixed)->CreateFixture(&walls, 0);
  std::printf("%s: rays %.1f %.1f, ", name, range(world, {0, 0}, {10, 0}), range(world, {4, 0}, {-6, 0}));
  b2Body* out = robot(world, 0);
  b2Body* in = robot(world, 4);
  for (int step = 0; step < 150; ++step) {
    out->SetLinearVelocity({1, 0});
    in->SetLinearVelocity({0, 0});
    world.Step(1 / 60.0f, 8, 3);
  }
  const bool is_kept = out->GetPosition().x < 2;
  for (int step = 0; step < 240; ++step) {
    out->SetLinearVelocity({0, 0});
    out->SetTransform({0, 9}, 0);
    in->SetLinearVelocity({-1, 0});
    world.Step(1 / 60.0f, 8, 3);
  }
  std::printf("kept in %d, kept out %d; ", is_kept, in->GetPosition().x > 2);
}

int main() {
  const b2Vec2 counterclockwise[] = {{-2, -2}, {2, -2}, {2, 2}, {-2, 2}}, clockwise[] = {{-2, 2}, {2, 2}, {2, -2}, {-2, -2}};
  b2ChainShape left, right;
  left.CreateLoop(counterclockwise, 4);
  right.CreateLoop(clockwise, 4);
  look_and_drive("counterclockwise", left);
  look_and_drive("clockwise", right);
  b2EdgeShape edge;
  edge.SetOneSided({-2, -2}, {2, -2}, {2, 2}, {-2, 2});
  look_and_drive("edge", edge);
}
CPP
compiled room.cpp -l:libbox2d.so.2
stated 'from within and from outside, wall at 2 m' \
  'counterclockwise: rays 2.0 2.0, kept in 0, kept out 1; clockwise: rays 2.0 2.0, kept in 1, kept out 0; edge: rays -1.0 2.0, kept in 0, kept out 1; ' \
  "$(with_libraries ./run)"
