// SPDX-License-Identifier: Apache-2.0
#include "tool/bays/bay_import.hpp"

#include <charconv>
#include <cmath>
#include <stdexcept>

#include "core/files/text_of_file.hpp"
#include "core/geometry/angle.hpp"
#include "tool/bays/rectangle.hpp"

namespace deltamap::tool {

std::optional<double> finite_number(const std::string& text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool is_number = error == std::errc{} && end == text.data() + text.size() && std::isfinite(value);
  return is_number ? std::optional{value} : std::nullopt;
}

BaySize bay_size_in(const std::string& text) {
  const std::size_t at = text.find('x');
  const auto along_m = finite_number(text.substr(0, at));
  const auto across_m = at == std::string::npos ? std::nullopt : finite_number(text.substr(at + 1));
  const bool is_size = along_m && across_m && *along_m > 0.0 && *across_m > 0.0;
  if (!is_size) throw std::runtime_error("--size: needs two lengths in metres, as 2.4x1.2, not '" + text + "'");
  return {*along_m, *across_m};
}

Polygon rectangle_of(const Pose2& map_from_bay, const BaySize& size) {
  const double x = 0.5 * size.along_m;
  const double y = 0.5 * size.across_m;
  return {map_from_bay * Point2{-x, -y}, map_from_bay * Point2{x, -y}, map_from_bay * Point2{x, y},
          map_from_bay * Point2{-x, y}};
}

ImportedBays imported_bays(const std::filesystem::path& file, const std::optional<BaySize>& size,
                           const std::vector<std::string>& layouts) {
  std::string text;
  try {
    text = text_of_file(file);
  } catch (const std::exception& error) {
    throw std::runtime_error(file.string() + ": " + error.what());
  }
  const std::string ending = file.extension().string();
  if (ending == ".lif" || ending == ".json") return bays_of_lif(text, file.string(), size, layouts);
  if (ending == ".csv" && !layouts.empty()) throw std::runtime_error(file.string() + ": a table has no layouts");
  if (ending == ".csv") return bays_of_csv(text, file.string(), size);
  throw std::runtime_error(file.string() + ": is neither .lif, .json nor .csv: rename it after what it holds");
}

}  // namespace deltamap::tool
