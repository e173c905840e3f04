// SPDX-License-Identifier: Apache-2.0
// What of the map has proven to stay, kept beside the store for the next run: earning it takes minutes of driving past
// everything. Belongs to one M_0 and one revision; cells that were rewritten since begin again.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "core/grid/grid_patch.hpp"
#include "localization/belief/stability_record.hpp"

namespace deltamap::daemon {

struct KeptStability {
  std::uint64_t first_map = 0;  ///< grid_hash() of M_0
  std::uint32_t revision = 0;   ///< of the map that it was earned on
  localization::belief::StabilityRecord record;
};

/// One JSON line that names map, revision and checksum, then the bytes of the record.
[[nodiscard]] std::string file_text(const KeptStability& kept);

struct KeptStabilityAnswer {
  std::optional<KeptStability> kept;
  std::string why_not;            ///< one line that names the file; empty where there is none to be read
  std::uint64_t fingerprint = 0;  ///< of the record, where it may be used
};
/// What is damaged or of another map is refused.
[[nodiscard]] KeptStabilityAnswer read_kept_stability(const std::filesystem::path& file, std::uint64_t first_map);

/// The same record where these cells have been rewritten since.
[[nodiscard]] localization::belief::StabilityRecord without(const localization::belief::StabilityRecord& record,
                                                            std::span<const CellChange> changes);

}  // namespace deltamap::daemon
