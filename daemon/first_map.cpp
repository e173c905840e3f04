// SPDX-License-Identifier: Apache-2.0
#include "daemon/first_map.hpp"

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <stdexcept>
#include <utility>

#include "core/files/grid_file.hpp"
#include "core/files/shortest_text.hpp"
#include "daemon/settings/settings_error.hpp"
#include "daemon/start_banner.hpp"

namespace deltamap::daemon {
namespace {

constexpr double kBytesOfAll = 24e6;  // the daemon on a map of a building, 181 beams, 500 particles
constexpr double kBytesOfACell =
    3.3;  // of a shown cell: grid, field, votes; 64 million cells took 229 MB with all stages at work
constexpr double kCoarsest_m = 0.25;  // walls are drawn a cell thick, and poses found to a fraction of one

std::string megabytes(double bytes) { return std::to_string(std::llround(bytes * 1e-6)) + " MB"; }

double bytes_needed(std::uint64_t cells) { return kBytesOfAll + kBytesOfACell * static_cast<double>(cells); }

/// Compares the memory that the map needs with the limits: throws above the hard one, returns a warning above the soft
/// one. The shown cells are counted only where a map that shows all its cells would not fit.
std::string judged_size(const std::filesystem::path& file, const GridGeometry& geometry, const MemoryLimit& limit) {
  const auto fits = [](double bytes, std::uint64_t most) { return bytes <= static_cast<double>(most); };
  const double at_most = bytes_needed(geometry.cell_count());
  if (fits(at_most, limit.most_bytes) && fits(at_most, limit.high_bytes)) return {};
  const double needed = bytes_needed(shown_cells(file));
  const std::string needs =
      file.string() + ": " + size_text(geometry) + " need about " + megabytes(needed) + " of memory, and there are ";
  if (!fits(needed, limit.most_bytes)) {
    const std::string why = needs + megabytes(static_cast<double>(limit.most_bytes)) + " (" + limit.most_of +
                            "): crop the map, make its cells larger, or give it more memory";
    if (limit.may_rise) throw MemoryShortage(why);
    throw std::runtime_error(why);
  }
  if (fits(needed, limit.high_bytes)) return {};
  return needs + megabytes(static_cast<double>(limit.high_bytes)) + " (" + limit.high_of + "): it will be slow";
}

}  // namespace

void require_map_named(const Settings& settings, const std::string& file) {
  if (settings.map.file.empty()) throw SettingsError(file + ": 'map.file' names no map");
  std::error_code error;
  if (!std::filesystem::exists(settings.map.file, error))
    throw SettingsError(settings.map.file + ": " + (error ? error.message() : "No such file or directory"));
}

FirstMap read_first_map(const std::filesystem::path& file, const MemoryLimit& limit) {
  const GridGeometry geometry = grid_file_geometry(file);
  std::vector<std::string> warnings;
  if (std::string slow = judged_size(file, geometry, limit); !slow.empty()) warnings.push_back(std::move(slow));
  if (geometry.resolution_m > kCoarsest_m) {
    warnings.push_back(file.string() + ": cells of " + shortest_text(geometry.resolution_m) +
                       " m are coarse: 0.05 to 0.1 m are usual");
  }
  GridWithNotes map = read_grid_with_notes(file);
  if (count_of(map.grid, CellState::kFree) == 0) {
    std::string why = file.string() + ": has no free cell, nowhere could a robot be";
    for (const std::string& note : map.notes) why += "; " + note.substr(file.string().size() + 2);
    throw std::runtime_error(why);
  }
  warnings.insert(warnings.end(), map.notes.begin(), map.notes.end());
  if (count_of(map.grid, CellState::kOccupied) == 0)
    warnings.push_back(file.string() + ": has no occupied cell, no beam can tell where the robot is");
  return {std::move(map.grid), std::move(warnings)};
}

std::string why_not_as_service(const std::filesystem::path& file, const UnitMemory& unit) {
  const double needed = bytes_needed(shown_cells(file));
  if (needed <= static_cast<double>(unit.most_bytes)) return {};
  return file.string() + ": needs about " + megabytes(needed) + " of memory, and the service may have " +
         megabytes(static_cast<double>(unit.most_bytes)) + " (" + unit.of +
         "): it would not start as a service; raise MemoryMax and MemoryHigh (sudo systemctl edit deltamap)";
}

std::string memory_text(const std::filesystem::path& file, const MemoryLimit& limit) {
  const auto limit_text = [](std::uint64_t bytes, const std::string& of) {
    return megabytes(static_cast<double>(bytes)) + " (" + of + ")";
  };
  std::string text = "about " + megabytes(bytes_needed(shown_cells(file)));
  text += limit.most_of.empty() ? ", no limit is known" : " of " + limit_text(limit.most_bytes, limit.most_of);
  if (!limit.high_of.empty()) text += ", slow from " + limit_text(limit.high_bytes, limit.high_of);
  return text;
}

}  // namespace deltamap::daemon
