// SPDX-License-Identifier: Apache-2.0
// Bays of a table, as a spreadsheet writes it: a comma or a semicolon between columns, quotes where a cell needs them.
#include <algorithm>
#include <map>
#include <stdexcept>
#include <utility>

#include "core/files/text_of_file.hpp"
#include "core/geometry/angle.hpp"
#include "core/trimmed.hpp"
#include "daemon/site/place_list.hpp"
#include "tool/bays/bay_import.hpp"
#include "tool/bays/rectangle.hpp"

namespace deltamap::tool {
namespace {

using mapping::bays::Bay;

const std::vector<std::string> kBayColumns{"id",          "name",    "stationId", "x_m",      "y_m",
                                           "heading_deg", "along_m", "across_m",  "polygon_m"};

struct TableRow {
  std::string place;  // "bays.csv: line 3"
  std::map<std::string, std::string> cells;

  [[noreturn]] void refuse(const std::string& why) const { throw std::runtime_error(place + ": " + why); }
  [[nodiscard]] std::string text(const std::string& column) const {
    const auto found = cells.find(column);
    return found == cells.end() ? "" : found->second;
  }
  [[nodiscard]] std::optional<double> number(const std::string& column) const {
    const std::string told = text(column);
    if (told.empty()) return std::nullopt;
    const auto value = finite_number(told);
    if (!value) refuse("'" + column + "' must be a number with a point, not '" + told + "'");
    return value;
  }
};

struct TableCells {
  std::vector<std::string> cells;
  bool is_open = false;  // the quotes of the last one are not closed
};

/// A quote at the beginning of a cell opens it (RFC 4180, 2.5); elsewhere it is a character: Shelf 19" left. `is_open`:
/// the line goes on in quotes.
TableCells cells_of(const std::string& line, char separator, bool is_open = false) {
  TableCells found{std::vector<std::string>(1), is_open};
  bool was_quoted = is_open;  // this cell
  for (std::size_t i = 0; i < line.size(); ++i) {
    std::string& cell = found.cells.back();
    if (found.is_open && line[i] == '"' && i + 1 < line.size() && line[i + 1] == '"') {
      cell += line[i++];
    } else if (found.is_open && line[i] == '"') {
      found.is_open = false;
    } else if (!found.is_open && line[i] == '"' && !was_quoted && trimmed(cell).empty()) {
      found.is_open = was_quoted = true;
    } else if (!found.is_open && line[i] == separator) {
      found.cells.emplace_back();
      was_quoted = false;
    } else {
      cell += line[i] == '\n' ? ' ' : line[i];
    }
  }
  for (std::string& cell : found.cells) cell = trimmed(cell);
  return found;
}

struct TableLine {
  std::size_t number;  // of the first, from 1
  std::string text;
};

/// A cell in quotes may hold line breaks (RFC 4180, 2.6): such lines belong together.
std::vector<TableLine> lines_in(const std::string& text, char separator) {
  std::vector<TableLine> lines;
  std::size_t number = 1;
  bool is_quoted = false;
  for (std::size_t from = 0; from < text.size(); ++number) {
    const std::size_t end = std::min(text.find('\n', from), text.size());
    std::string line = text.substr(from, end - from);
    if (line.ends_with('\r')) line.pop_back();
    if (is_quoted) {
      lines.back().text += '\n' + line;
    } else {
      lines.push_back({number, line});
    }
    is_quoted = cells_of(line, separator, is_quoted).is_open;
    from = end + 1;
  }
  return lines;
}

/// "1 2; 3 2; 3 4"
Polygon polygon_of(const TableRow& row, const std::string& told) {
  Polygon polygon;
  for (const std::string& corner : cells_of(told, ';').cells) {
    const std::size_t gap = corner.find(' ');
    const auto x_m = finite_number(corner.substr(0, gap));
    const auto y_m = gap == std::string::npos ? std::nullopt : finite_number(trimmed(corner.substr(gap)));
    if (!x_m || !y_m) row.refuse("'polygon_m' must be corners as 'x y; x y; x y', not '" + told + "'");
    polygon.emplace_back(*x_m, *y_m);
  }
  polygon = daemon::without_repeated_corners(std::move(polygon));
  if (polygon.size() < 3) row.refuse("'polygon_m' needs at least three corners");
  return polygon;
}

Bay bay_of(const TableRow& row, const std::optional<BaySize>& size) {
  Bay bay{.id = row.text("id"), .name = row.text("name"), .station_id = row.text("stationId"), .polygon = {}};
  if (bay.id.empty()) row.refuse("'id' is empty");
  if (const std::string told = row.text("polygon_m"); !told.empty()) {
    bay.polygon = polygon_of(row, told);
    return bay;
  }
  const auto x_m = row.number("x_m");
  const auto y_m = row.number("y_m");
  if (!x_m || !y_m) row.refuse("bay '" + bay.id + "' needs x_m and y_m, or polygon_m");
  const auto along_m = row.number("along_m");
  const auto across_m = row.number("across_m");
  if (along_m.has_value() != across_m.has_value())
    row.refuse("bay '" + bay.id + "' has one of along_m and across_m: give both or none");
  const bool has_size = along_m && across_m;
  if (!has_size && !size)
    row.refuse("bay '" + bay.id + "' has no size: give along_m and across_m, or --size ALONGxACROSS in metres");
  const BaySize own = has_size ? BaySize{*along_m, *across_m} : *size;
  if (!(own.along_m > 0.0 && own.across_m > 0.0)) row.refuse("bay '" + bay.id + "' needs sides longer than 0");
  bay.polygon = rectangle_of({*x_m, *y_m, wrapped_angle(radians(row.number("heading_deg").value_or(0.0)))}, own);
  return bay;
}

}  // namespace

ImportedBays bays_of_csv(const std::string& text, const std::string& name, const std::optional<BaySize>& size) {
  daemon::require_text(text, name);
  const std::string table = text.substr(text.starts_with(kUtf8Mark) ? kUtf8Mark.size() : 0);
  if (table.empty()) throw std::runtime_error(name + ": is empty");
  const char separator = table.substr(0, table.find('\n')).find(';') == std::string::npos ? ',' : ';';
  const std::vector<TableLine> lines = lines_in(table, separator);
  const std::vector<std::string> columns = cells_of(lines[0].text, separator).cells;
  for (const std::string& column : columns) {
    if (std::find(kBayColumns.begin(), kBayColumns.end(), column) == kBayColumns.end())
      TableRow{name + ": line 1", {}}.refuse("nothing is called '" + column +
                                             "' here: id, name, stationId, x_m, y_m, heading_deg, along_m, across_m, "
                                             "polygon_m");
    if (std::count(columns.begin(), columns.end(), column) > 1)
      TableRow{name + ": line 1", {}}.refuse("'" + column + "' stands twice");
  }
  ImportedBays bays;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    if (trimmed(lines[i].text).empty()) continue;
    const auto [cells, is_open] = cells_of(lines[i].text, separator);
    TableRow row{name + ": line " + std::to_string(lines[i].number), {}};
    if (is_open) row.refuse("has a quote that is not closed");
    if (cells.size() != columns.size())
      row.refuse("has " + std::to_string(cells.size()) + " cells, the first line " + std::to_string(columns.size()));
    for (std::size_t c = 0; c < columns.size(); ++c) row.cells[columns[c]] = cells[c];
    bays.bays.push_back(bay_of(row, size));
  }
  return bays;
}

}  // namespace deltamap::tool
