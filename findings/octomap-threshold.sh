#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Guess: an OctoMap that was written and read again is the same map: what was free is free, what was occupied is occupied; .ot keeps
#   the probabilities, .bt two classes of them.
# Seen: neither file has the threshold, nor the hit and miss probabilities. With a threshold of 0.7 a voxel of 0.69 is free; read from .ot it is
#   occupied, since the threshold is 0.5 again, and one more scan weighs 0.7 where the map was made with 0.6. From .bt it is free, with
#   0.12: its evidence is gone, and a hit makes 0.24 of it. So the two files of one tree disagree, each with no word.
# Matters: maps are made with a threshold against ghosts (people, glass) and served by another process: the ghosts are obstacles there, or a
#   thin wall that had nearly been enough is free by the same amount as a floor that was seen a hundred times.
# Version: OctoMap 1.9.7 (liboctomap1.9 1.9.7+dfsg-3+b1). Source: AbstractOcTree.h: write() "file header and complete tree"; writeData "complete
#   state of tree"; AbstractOccupancyOcTree.h: writeBinary writes the maximum likelihood tree.
set -euo pipefail
source "$(dirname "$0")/lib/pinned.bash"

debian_programs liboctomap1.9=1.9.7+dfsg-3+b1
debian_files liboctomap-dev=1.9.7+dfsg-3+b1
cat > keep.cpp << 'CPP'
#include <octomap/octomap.h>

#include <cstdio>
#include <memory>

const octomap::point3d kPlace(0.05, 0.05, 0.05);

void tell(const char* name, octomap::OcTree& tree) {
  const octomap::OcTreeNode* node = tree.search(kPlace);
  std::printf("%s: %.2f, occupied %d, threshold %.1f", name, node->getOccupancy(), tree.isNodeOccupied(node),
              tree.getOccupancyThres());
  std::printf(", one hit later %.2f; ", tree.updateNode(kPlace, true)->getOccupancy());
}

int main() {
  octomap::OcTree tree(0.1);
  tree.setOccupancyThres(0.7);
  tree.setProbHit(0.6);
  for (int hit = 0; hit < 2; ++hit) tree.updateNode(kPlace, true);
  tree.write("map.ot");
  octomap::OcTree copy(tree);
  copy.writeBinary("map.bt");
  const std::unique_ptr<octomap::AbstractOcTree> read(octomap::AbstractOcTree::read("map.ot"));
  octomap::OcTree binary("map.bt");
  tell("made", tree);
  tell("ot", dynamic_cast<octomap::OcTree&>(*read));
  tell("bt", binary);
}
CPP
compiled keep.cpp -l:liboctomap.so.1.9 -l:liboctomath.so.1.9
expected='made: 0.69, occupied 0, threshold 0.7, one hit later 0.77; ot: 0.69, occupied 1, threshold 0.5, one hit later 0.84; '
stated 'a voxel' "$expected"'bt: 0.12, occupied 0, threshold 0.5, one hit later 0.24; ' "$(with_libraries ./run 2> /dev/null)"
