#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Guess: Bullet's rayTest hits a convex hull of eight corners where it hits the box with these corners: the collision margin is for contacts.
# Seen: a box is hit at its face, the hull of the same corners 4 cm before it, and a ray that passes 3 cm beside the hull hits it: the
#   margin is laid around hulls, and for rays as well. 4 cm is the default, whatever the size of the body. With setMargin(0)
#   both agree, and a compound of boxes is as its boxes.
# Matters: a simulated laser reads 4 cm short of each mesh that was turned into hulls, and sees posts of 4 cm as ones of 12; next to boxes
#   in the same hall, which are right, it looks like a laser's bias by material. A map that is drawn from it has narrow doors.
# Version: Bullet 3.24 (libbullet3.24 3.24+dfsg-2). Source: its manual tells of margins that convex hulls are to be shrunk for, and of rays
#   that they hit "the shape"; btBoxShape.h puts its margin inside.
set -euo pipefail
source "$(dirname "$0")/lib/pinned.bash"

debian_programs libbullet3.24=3.24+dfsg-2
debian_files libbullet-dev=3.24+dfsg-2
cat > rays.cpp << 'CPP'
#include <btBulletCollisionCommon.h>

#include <cstdio>

void look(const char* name, btCollisionShape& shape) {
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  btDbvtBroadphase broad;
  btCollisionWorld world(&dispatcher, &broad, &configuration);
  btCollisionObject body;
  body.setCollisionShape(&shape);
  world.addCollisionObject(&body);
  std::printf("%s:", name);
  for (const btScalar aside : {0.0f, 1.03f}) {
    const btVector3 from(-3, aside, 0), to(3, aside, 0);
    btCollisionWorld::ClosestRayResultCallback nearest(from, to);
    world.rayTest(from, to, nearest);
    std::printf(nearest.hasHit() ? " %.2f" : " none", 6 * nearest.m_closestHitFraction);
  }
  std::printf("; ");
  world.removeCollisionObject(&body);
}

int main() {
  btBoxShape box(btVector3(1, 1, 1));
  btConvexHullShape hull, bare;
  for (int corner = 0; corner < 8; ++corner) {
    const btVector3 point(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
    hull.addPoint(point);
    bare.addPoint(point);
  }
  bare.setMargin(0);
  btCompoundShape compound;
  compound.addChildShape(btTransform::getIdentity(), &box);
  look("box", box);
  look("compound", compound);
  look("hull", hull);
  look("hull without margin", bare);
}
CPP
compiled rays.cpp -isystem "$root/usr/include/bullet" -l:libBulletCollision.so.3.24 -l:libLinearMath.so.3.24
stated 'ranges to a face at 2 m, and 3 cm beside the cube' \
  'box: 2.00 none; compound: 2.00 none; hull: 1.96 1.97; hull without margin: 2.00 none; ' "$(with_libraries ./run)"
