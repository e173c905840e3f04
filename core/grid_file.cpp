// SPDX-License-Identifier: Apache-2.0
#include "core/grid_file.hpp"

#include <yaml-cpp/yaml.h>

#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "core/replace_file.hpp"
#include "core/shortest_text.hpp"

namespace deltamap {
namespace {

constexpr double kFinest_m = 0.001;  // sides of a cell
constexpr double kCoarsest_m = 100.0;
constexpr int kMaxSide = 32767;  // cells; 16-bit indices suffice everywhere

struct MapKeys {
  std::string image;
  double resolution_m = 0.0;
  Point2 origin{0.0, 0.0};
  bool negate = false;
  double occupied_threshold = 0.65;
  double free_threshold = 0.196;
};

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& why) {
  throw std::runtime_error(file.string() + ": " + why);
}

std::string read_bytes(const std::filesystem::path& file) {
  if (std::filesystem::is_directory(file)) refuse(file, "is a directory");
  std::ifstream in(file, std::ios::binary);
  if (!in) refuse(file, std::strerror(errno));
  return {std::istreambuf_iterator<char>(in), {}};
}

double number(const YAML::Node& map, const std::string& key, const std::filesystem::path& file) {
  const YAML::Node node = map[key];
  if (!node) refuse(file, "key '" + key + "' is missing");
  try {
    const auto value = node.as<double>();
    if (std::isfinite(value)) return value;
  } catch (const YAML::Exception&) {  // told below, with the line
  }
  refuse(file, "line " + std::to_string(node.Mark().line + 1) + ": '" + key + "' is not a number");
}

MapKeys parse_keys(const std::filesystem::path& file) {
  YAML::Node map;
  const std::string text = read_bytes(file);
  if (is_carmen_map(file, text)) refuse(file, "is a CARMEN map; give a map_server map (YAML and PGM)");
  try {
    map = YAML::Load(text);
  } catch (const YAML::Exception& error) {
    refuse(file, "line " + std::to_string(error.mark.line + 1) + ": " + error.msg);
  }
  if (!map.IsMap()) refuse(file, "line 1: not a map description (expected 'image', 'resolution', 'origin')");
  MapKeys keys;
  if (!map["image"] || !map["image"].IsScalar()) refuse(file, "key 'image' is missing");
  keys.image = map["image"].as<std::string>();
  keys.resolution_m = number(map, "resolution", file);
  if (!(keys.resolution_m > 0.0)) refuse(file, "'resolution' must be positive");
  if (keys.resolution_m < kFinest_m || keys.resolution_m > kCoarsest_m)
    refuse(file, "'resolution' must be 0.001 to 100 m");
  const YAML::Node origin = map["origin"];
  if (!origin || !origin.IsSequence() || origin.size() < 2) refuse(file, "'origin' must be [x, y, yaw]");
  std::array<double, 3> values{};
  for (std::size_t i = 0; i < std::min<std::size_t>(3, origin.size()); ++i) {
    try {
      values[i] = origin[i].as<double>();
    } catch (const YAML::Exception&) {
      refuse(file, "line " + std::to_string(origin.Mark().line + 1) + ": 'origin' must hold numbers");
    }
  }
  if (!std::isfinite(values[0]) || !std::isfinite(values[1])) refuse(file, "'origin' must be finite");
  if (values[2] != 0.0)
    refuse(file, "a rotated origin (yaw " + std::to_string(values[2]) + ") is not supported; turn the image");
  keys.origin = {values[0], values[1]};
  if (map["negate"]) keys.negate = number(map, "negate", file) != 0.0;
  if (map["occupied_thresh"]) keys.occupied_threshold = number(map, "occupied_thresh", file);
  if (map["free_thresh"]) keys.free_threshold = number(map, "free_thresh", file);
  if (map["mode"] && map["mode"].as<std::string>("") != "trinary") refuse(file, "only 'mode: trinary' is supported");
  return keys;
}

/// The header of a binary PGM: numbers separated by white space and comments.
class PgmHeader {
 public:
  PgmHeader(const std::string& bytes, const std::filesystem::path& file) : bytes_{bytes}, file_{file} {
    if (bytes.size() < 2 || bytes[0] != 'P' || bytes[1] != '5') refuse(file, "byte 0: not a binary PGM (P5)");
  }
  int next_number(int most) {
    skip_space();
    const std::size_t start = at_;
    long value = 0;
    while (at_ < bytes_.size() && bytes_[at_] >= '0' && bytes_[at_] <= '9' && value <= most) {
      value = value * 10 + (bytes_[at_++] - '0');
    }
    if (at_ == start || value < 1 || value > most) {
      refuse(file_, "byte " + std::to_string(start) + ": expected a number from 1 to " + std::to_string(most));
    }
    return static_cast<int>(value);
  }
  /// Where the pixels begin: after exactly one white space.
  [[nodiscard]] std::size_t end() const { return at_ + 1; }

 private:
  void skip_space() {
    while (at_ < bytes_.size()) {
      if (bytes_[at_] == '#') {
        at_ = std::min(bytes_.find('\n', at_), bytes_.size());
      } else if (std::isspace(static_cast<unsigned char>(bytes_[at_])) != 0) {
        ++at_;
      } else {
        return;
      }
    }
  }
  const std::string& bytes_;
  const std::filesystem::path& file_;
  std::size_t at_ = 2;
};

CellState state_of(double darkness, const MapKeys& keys) {
  if (darkness > keys.occupied_threshold) return CellState::kOccupied;
  return darkness < keys.free_threshold ? CellState::kFree : CellState::kUnknown;
}

std::array<CellState, 256> cell_states(int brightest, const MapKeys& keys) {
  std::array<CellState, 256> states{};
  for (int shade = 0; shade < 256; ++shade) {
    const double light = static_cast<double>(std::min(shade, brightest)) / brightest;
    states[static_cast<std::size_t>(shade)] = state_of(keys.negate ? light : 1.0 - light, keys);
  }
  return states;
}

char shade_of(CellState state) {
  switch (state) {
    case CellState::kOccupied:
      return static_cast<char>(0);
    case CellState::kFree:
      return static_cast<char>(254);
    case CellState::kUnknown:
      break;
  }
  return static_cast<char>(205);
}

std::string pgm_of(const OccupancyGrid& grid) {
  std::string pgm = "P5\n" + std::to_string(grid.width()) + " " + std::to_string(grid.height()) + "\n255\n";
  pgm.reserve(pgm.size() + grid.cells().size());
  for (int row = grid.height() - 1; row >= 0; --row) {
    for (int column = 0; column < grid.width(); ++column) pgm += shade_of(grid[{column, row}]);
  }
  return pgm;
}

std::string yaml_of(const OccupancyGrid& grid, const std::string& image) {
  const Point2& origin = grid.geometry().origin;
  return "image: " + image + "\nresolution: " + shortest_text(grid.resolution_m()) + "\norigin: [" +
         shortest_text(origin.x()) + ", " + shortest_text(origin.y()) +
         ", 0.0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n";
}

}  // namespace

bool is_carmen_map(const std::filesystem::path& file, std::string_view first_bytes) {
  constexpr std::size_t kLongestHeader = 4096;  // lines of comment come before the magic word
  if (first_bytes.starts_with("\x1F\x8B")) {
    return file.extension() == ".map" || file.stem().extension() == ".map";  // of X.map and X.map.gz
  }
  return first_bytes.substr(0, kLongestHeader).find("CARMENMAPFILE") != std::string_view::npos;
}

OccupancyGrid read_grid(const std::filesystem::path& yaml_file) {
  const MapKeys keys = parse_keys(yaml_file);
  const std::filesystem::path image = yaml_file.parent_path() / keys.image;  // an absolute image path stands for itself
  const std::string bytes = read_bytes(image);
  PgmHeader header{bytes, image};
  const int width = header.next_number(kMaxSide);
  const int height = header.next_number(kMaxSide);
  const int brightest = header.next_number(255);
  const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  if (bytes.size() < header.end() + pixels) {
    refuse(image, "byte " + std::to_string(bytes.size()) + ": cut short, " + std::to_string(width) + " x " +
                      std::to_string(height) + " cells need " + std::to_string(header.end() + pixels) + " bytes");
  }
  const auto states = cell_states(brightest, keys);
  OccupancyGrid grid{{width, height, keys.resolution_m, keys.origin}};
  const char* pixel = bytes.data() + header.end();
  for (int row = height - 1; row >= 0; --row) {
    for (int column = 0; column < width; ++column)
      grid.set({column, row}, states[static_cast<unsigned char>(*pixel++)]);
  }
  return grid;
}

void write_grid(const OccupancyGrid& grid, const std::filesystem::path& yaml_file) {
  std::filesystem::path image = yaml_file;
  image.replace_extension(".pgm");
  replace_file(image, pgm_of(grid));
  replace_file(yaml_file, yaml_of(grid, image.filename().string()));
}

}  // namespace deltamap
