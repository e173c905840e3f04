// SPDX-License-Identifier: Apache-2.0
// Other programs' lists of places as bays: the stations of a LIF 1.0 file (Layout Interchange Format of the VDMA, JSON)
// and tables (CSV). A station is a point: how large its bay is, a person says.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "mapping/bays/bay.hpp"

namespace deltamap::tool {

/// Along and across the direction in which a vehicle stands at the station, m.
struct BaySize {
  double along_m = 0.0;
  double across_m = 0.0;
};
/// "2.4x1.2"; throws std::runtime_error.
[[nodiscard]] BaySize bay_size_in(const std::string& text);

struct ImportedBays {
  std::vector<mapping::bays::Bay> bays;
  std::vector<std::string> left_out;  ///< a line each: what, where, why
};

/// By its ending, .lif, .json or .csv. Throws std::runtime_error: one line with the file and the place in it. A table
/// has no layouts.
[[nodiscard]] ImportedBays imported_bays(const std::filesystem::path& file, const std::optional<BaySize>& size,
                                         const std::vector<std::string>& layouts = {});

/// From the text of a LIF file; `name` stands for it. Of the layouts with these layoutIds; without any of all, which
/// then must not be of several floors (layoutLevelId): they share one origin.
[[nodiscard]] ImportedBays bays_of_lif(const std::string& text, const std::string& name,
                                       const std::optional<BaySize>& size,
                                       const std::vector<std::string>& layouts = {});
/// The first line names the columns: id; x_m and y_m of the middle, or polygon_m ("x y; x y; x y"); and, as wanted,
/// heading_deg, along_m, across_m, name, stationId.
[[nodiscard]] ImportedBays bays_of_csv(const std::string& text, const std::string& name,
                                       const std::optional<BaySize>& size);

}  // namespace deltamap::tool
