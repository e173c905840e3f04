// SPDX-License-Identifier: Apache-2.0
// The map as the localizer knows it: within ignored zones it knows nothing, so that neither what the map has there nor
// beams that end there tell of the pose. Everybody else goes by the whole map.
#pragma once

#include <memory>

#include "core/messages.hpp"
#include "core/zones.hpp"
#include "localization/localizer_params.hpp"

namespace deltamap::daemon {

class IgnoredGround {
 public:
  IgnoredGround(const Zones& zones, std::shared_ptr<const OccupancyGrid> map);

  /// The revision as the localizer takes it: itself where nothing is ignored.
  [[nodiscard]] MapRevision follow(const MapRevision& revision, const localization::LocalizerParams& params);
  /// True where the localizer's map is another one.
  [[nodiscard]] bool set_zones(const Zones& zones);

  [[nodiscard]] const std::shared_ptr<const OccupancyGrid>& whole() const { return whole_; }
  [[nodiscard]] const std::shared_ptr<const OccupancyGrid>& known() const { return known_; }

 private:
  [[nodiscard]] std::shared_ptr<const OccupancyGrid> without_ignored() const;

  ZonedGround ground_;
  std::shared_ptr<const OccupancyGrid> whole_;
  std::shared_ptr<const OccupancyGrid> known_;
};

}  // namespace deltamap::daemon
