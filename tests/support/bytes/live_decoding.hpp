// SPDX-License-Identifier: Apache-2.0
// Reads the live page's binary messages, as docs/api.md describes them.
#pragma once

#include <bit>
#include <cstdint>
#include <string>
#include <vector>

#include "core/grid/occupancy_grid.hpp"

namespace deltamap::test {

inline std::uint64_t number_at(const std::string& bytes, std::size_t at, std::size_t size) {
  std::uint64_t number = 0;
  for (std::size_t i = size; i-- > 0;) number = number << 8U | static_cast<unsigned char>(bytes.at(at + i));
  return number;
}
inline std::uint32_t u32_at(const std::string& bytes, std::size_t at) {
  return static_cast<std::uint32_t>(number_at(bytes, at, 4));
}
inline int i32_at(const std::string& bytes, std::size_t at) { return static_cast<int>(u32_at(bytes, at)); }
inline float f32_at(const std::string& bytes, std::size_t at) { return std::bit_cast<float>(u32_at(bytes, at)); }
inline double f64_at(const std::string& bytes, std::size_t at) {
  return std::bit_cast<double>(number_at(bytes, at, 8));
}

struct CellsInBox {
  std::uint32_t revision = 0;
  CellBox box;
  std::vector<CellState> states;
};

inline CellsInBox decoded_cells(const std::string& bytes) {
  const int column = i32_at(bytes, 8);
  const int row = i32_at(bytes, 12);
  CellsInBox cells{u32_at(bytes, 4), {{column, row}, {column + i32_at(bytes, 16), row + i32_at(bytes, 20)}}, {}};
  for (std::size_t at = 24; at < bytes.size(); at += 2) {
    const auto run = static_cast<unsigned>(number_at(bytes, at, 2));
    cells.states.insert(cells.states.end(), run & 0x3FFFU, static_cast<CellState>(run >> 14U));
  }
  return cells;
}

}  // namespace deltamap::test
