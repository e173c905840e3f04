// SPDX-License-Identifier: Apache-2.0
#include "experiments/drive/localizer_variants.hpp"

namespace deltamap::experiments {

std::vector<LocalizerVariant> localizer_variants(const localization::LocalizerParams& given) {
  localization::LocalizerParams peers = given;
  peers.particles.min = peers.particles.max = 500;
  peers.beams = 60;
  return {{"500x60", peers}, {"delivered", given}};
}

}  // namespace deltamap::experiments
