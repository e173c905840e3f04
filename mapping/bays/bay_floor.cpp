// SPDX-License-Identifier: Apache-2.0
#include "mapping/bays/bay_floor.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "core/geometry/points_in_map.hpp"
#include "mapping/bays/straight_faces.hpp"

namespace deltamap::mapping::bays {
namespace {

constexpr double kLeastEdge_m = 0.1;
constexpr double kMostEdge_m = 0.25;
constexpr double kCellsAlong = 12.0;  // of the longest side, where the edge lets them be
constexpr std::size_t kMostCells = std::size_t{kMostCellsAlong} * kMostCellsAlong;
constexpr double kRim_m = 0.25;  // so far before the bay a face may stand that belongs to what stands in it
constexpr double kFreeBefore_m = 0.15;

constexpr std::int8_t kSurelyFree = -3;
constexpr std::int8_t kFree = -2;
constexpr std::int8_t kTaken = 4;  // from surely free on 1.4 s of looks: a person walks on
constexpr std::int8_t kSurelyTaken = 6;
constexpr std::uint8_t kShadowLooks = 2;
constexpr double kBody_m = 1.6;  // across: two people beside each other are smaller
constexpr int kEndOnFace = 2;    // looks that an end on a straight face counts for: people have none
constexpr std::uint8_t kFaceLooks = 2;
constexpr std::uint8_t kMostFaceLooks = 4;
constexpr std::uint32_t kMostWindow_ds = 100;

enum Mark : std::uint8_t { kWentThrough = 1, kEnded = 2, kBehindBody = 4, kOnFace = 8 };

/// Distance of a point from the polygon's sides.
double distance_from_sides(const Polygon& polygon, const Point2& point) {
  double least = HUGE_VAL;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point2& from = polygon[i];
    const Point2 side = polygon[(i + 1) % polygon.size()] - from;
    const double share = std::clamp((point - from).dot(side) / side.squaredNorm(), 0.0, 1.0);
    least = std::min(least, (from + share * side - point).norm());
  }
  return least;
}

/// With its x along the longest side.
double heading_of(const Polygon& polygon) {
  Point2 longest{0.0, 0.0};
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point2 side = polygon[(i + 1) % polygon.size()] - polygon[i];
    if (side.norm() > longest.norm() + 1e-6) longest = side;
  }
  return std::atan2(longest.y(), longest.x());
}

}  // namespace

BayFloor::BayFloor(const Polygon& polygon) {
  const Pose2 turned{0.0, 0.0, heading_of(polygon)};
  Polygon in_bay;
  for (const Point2& corner : polygon) in_bay.push_back(inverse(turned) * corner);
  const PolygonBox box = bounding_box(in_bay);
  const Point2 size = box.high - box.low;
  const double longest_m = size.maxCoeff();
  layout_.edge_m =
      std::max(std::clamp(longest_m / kCellsAlong, kLeastEdge_m, kMostEdge_m), longest_m / kMostCellsAlong);
  layout_.columns = std::clamp(static_cast<int>(std::lround(size.x() / layout_.edge_m)), 1, kMostCellsAlong);
  layout_.rows = std::clamp(static_cast<int>(std::lround(size.y() / layout_.edge_m)), 1, kMostCellsAlong);
  // The cells are centred on the box: half a cell of it may lie beyond.
  const Point2 spare = size - layout_.edge_m * Point2{layout_.columns, layout_.rows};
  const Point2 corner = turned * Point2{box.low + 0.5 * spare};
  const Pose2 map_from_bay{corner.x(), corner.y(), turned.theta};
  bay_from_map_ = inverse(map_from_bay);
  middle_ = turned * Point2{0.5 * (box.low + box.high)};
  radius_m_ = 0.5 * size.norm() + kRim_m;
  cells_.resize(static_cast<std::size_t>(layout_.cells()));
  for (int row = 0; row < layout_.rows; ++row) {
    for (int column = 0; column < layout_.columns; ++column) {
      const int place = row * layout_.columns + column;
      FloorCell& cell = cells_[static_cast<std::size_t>(place)];
      const Point2 at = map_from_bay * Point2{(column + 0.5) * layout_.edge_m, (row + 0.5) * layout_.edge_m};
      cell.is_inside = contains(polygon, at);
      cell.is_core = cell.is_inside && distance_from_sides(polygon, at) >= 0.75 * layout_.edge_m;
      core_cells_ += cell.is_core ? 1 : 0;
    }
  }
}

void BayFloor::forget() {
  for (FloorCell& cell : cells_) {
    cell.seen_ds = 0;
    cell.free_ds = 0;
    cell.evidence = 0;
    cell.shadows = 0;
    cell.faces = 0;
    cell.is_body = false;
    cell.is_risen = false;
  }
}

void BayFloor::take_as_told() {
  for (FloorCell& cell : cells_) cell.is_risen = false;
}

std::optional<std::size_t> BayFloor::mark_beam(const Point2& from, const Point2& end) {
  const double range_m = (end - from).norm();
  if (range_m <= 0.0) return std::nullopt;
  const LineOfCells path = cells_on_line(layout_, from, (end - from) / range_m, range_m + kRim_m);
  const auto cell_of = [&](int step) -> FloorCell& { return cells_[static_cast<std::size_t>(path[step].cell)]; };
  int first = 0;
  while (first < path.count && !cell_of(first).is_inside) ++first;
  int last_core = path.count - 1;
  while (last_core >= first && !cell_of(last_core).is_core) --last_core;
  if (last_core < first) return std::nullopt;  // it touches the rim alone
  const double enters_m = path[first].from_m;
  if (range_m < enters_m - kRim_m) return std::nullopt;  // something before the bay covers it
  int hit = first;
  while (hit <= last_core && path[hit].to_m <= range_m) ++hit;
  const bool ends_inside = hit <= last_core;
  // Also of the rim beyond the floor: a face that stood there may have gone.
  const int last = ends_inside ? hit : path.count - 1;
  for (int i = first; i <= last; ++i) {
    if (path[i].to_m <= range_m - kFreeBefore_m) cell_of(i).marks |= kWentThrough;
  }
  if (!ends_inside) return std::nullopt;
  FloorCell& face = cell_of(hit);
  face.marks |= kEnded;
  for (int i = hit + 1; face.is_body && i <= last_core; ++i) {
    FloorCell& behind = cell_of(i);
    if (behind.free_ds <= face.since_ds) behind.marks |= kBehindBody;  // else it was free, seen from elsewhere
  }
  return static_cast<std::size_t>(path[hit].cell);
}

/// Of beams that follow each other and all end in the bay.
struct BayFloor::BeamEnds {
  std::vector<Point2> in_bay;
  std::vector<std::size_t> cells;
};

void BayFloor::mark_faces(BeamEnds& ends) {
  for (const StraightFace& face : straight_faces(ends.in_bay)) {
    for (std::size_t i = face.first; i < face.last; ++i) cells_[ends.cells[i]].marks |= kOnFace;
  }
  ends.in_bay.clear();
  ends.cells.clear();
}

/// A body through which beams go, and in which none ends, has gone, and its shadow with it.
void BayFloor::drop_lost_shadows() {
  bool is_lost = false;
  for (const FloorCell& cell : cells_) {
    if (!cell.is_body) continue;
    if ((cell.marks & kEnded) != 0) return;
    is_lost = is_lost || (cell.evidence <= kTaken && (cell.marks & kWentThrough) != 0);
  }
  if (!is_lost) return;
  for (FloorCell& cell : cells_) {
    if ((cell.marks & kBehindBody) == 0) cell.shadows = 0;
  }
}

/// A pose that is a little off moves the face of a load by a cell: that is no new one.
bool BayFloor::is_beside_what_stood(std::size_t index) const {
  const int column = static_cast<int>(index) % layout_.columns;
  const int row = static_cast<int>(index) / layout_.columns;
  for (int r = std::max(0, row - 1); r <= std::min(layout_.rows - 1, row + 1); ++r) {
    for (int c = std::max(0, column - 1); c <= std::min(layout_.columns - 1, column + 1); ++c) {
      const int place = r * layout_.columns + c;
      const FloorCell& beside = cells_[static_cast<std::size_t>(place)];
      if (beside.is_gathered && !beside.is_risen) return true;
    }
  }
  return false;
}

void BayFloor::take_end(std::size_t index, std::uint32_t time_ds) {
  FloorCell& cell = cells_[index];
  const bool is_on_face = (cell.marks & kOnFace) != 0;
  cell.faces = static_cast<std::uint8_t>(std::clamp<int>(cell.faces + (is_on_face ? 1 : -1), 0, kMostFaceLooks));
  const int evidence = cell.evidence + (is_on_face ? kEndOnFace : 1);
  if (cell.evidence < kTaken && evidence >= kTaken) {
    cell.since_ds = time_ds;
    cell.is_risen = cell.free_ds > 0 && !is_beside_what_stood(index);
  }
  cell.evidence = static_cast<std::int8_t>(std::min<int>(evidence, kSurelyTaken));
  if (cell.evidence >= kTaken) cell.seen_ds = time_ds;
}

void BayFloor::take_marks(std::uint32_t time_ds) {
  drop_lost_shadows();
  for (std::size_t index = 0; index < cells_.size(); ++index) {
    FloorCell& cell = cells_[index];
    const std::uint8_t marks = cell.marks;
    if (marks == 0) continue;
    if ((marks & kEnded) != 0) {
      take_end(index, time_ds);
    } else if ((marks & kWentThrough) != 0) {
      cell.evidence = static_cast<std::int8_t>(std::max<int>(cell.evidence - 1, kSurelyFree));
      cell.shadows = 0;
      cell.faces = 0;
      cell.free_ds = time_ds;
      if (cell.evidence <= kFree) {
        cell.seen_ds = time_ds;
        cell.is_risen = false;
      }
    } else if (cell.evidence < kTaken) {
      // What was free before the body came says nothing of what is behind it now.
      if (cell.evidence < 0) cell.evidence = static_cast<std::int8_t>(std::min<int>(cell.evidence + 2, 0));
      cell.shadows = static_cast<std::uint8_t>(std::min<int>(cell.shadows + 1, kShadowLooks));
      if (cell.evidence > kFree) cell.seen_ds = time_ds;
    } else {
      cell.seen_ds = time_ds;
    }
    cell.marks = 0;
  }
}

/// Ends of beams that touch each other, and those of them that wait to be looked around.
struct BayFloor::Cluster {
  std::array<std::int16_t, kMostCells> members;
  std::size_t count = 0;
  int low_column = kMostCellsAlong;
  int high_column = 0;
  int low_row = kMostCellsAlong;
  int high_row = 0;

  void add(int cell, int columns) {
    members[count++] = static_cast<std::int16_t>(cell);
    low_column = std::min(low_column, cell % columns);
    high_column = std::max(high_column, cell % columns);
    low_row = std::min(low_row, cell / columns);
    high_row = std::max(high_row, cell / columns);
  }
  [[nodiscard]] double across_m(double edge_m) const {
    return edge_m * std::hypot(high_column - low_column + 0.5, high_row - low_row + 0.5);
  }
};

BayFloor::Cluster BayFloor::cluster_from(int start) {
  Cluster cluster;
  const auto take = [&](int index) {
    FloorCell& cell = cells_[static_cast<std::size_t>(index)];
    if (cell.is_gathered || cell.evidence < kTaken) return;
    cell.is_gathered = true;
    cluster.add(index, layout_.columns);
  };
  take(start);
  for (std::size_t next = 0; next < cluster.count; ++next) {
    const int column = cluster.members[next] % layout_.columns;
    const int row = cluster.members[next] / layout_.columns;
    for (int r = std::max(0, row - 1); r <= std::min(layout_.rows - 1, row + 1); ++r) {
      for (int c = std::max(0, column - 1); c <= std::min(layout_.columns - 1, column + 1); ++c)
        take(r * layout_.columns + c);
    }
  }
  return cluster;
}

/// Ends of beams that touch each other are one body, where a straight face is among them, or it is too large for
/// people.
void BayFloor::find_bodies() {
  for (FloorCell& cell : cells_) cell.is_body = cell.is_gathered = false;
  for (int start = 0; start < layout_.cells(); ++start) {
    if (cells_[static_cast<std::size_t>(start)].evidence < kTaken) continue;
    const Cluster cluster = cluster_from(start);
    const std::span members{cluster.members.data(), cluster.count};
    const bool has_face = std::any_of(members.begin(), members.end(), [&](std::int16_t member) {
      return cells_[static_cast<std::size_t>(member)].faces >= kFaceLooks;
    });
    if (cluster.count == 0 || (!has_face && cluster.across_m(layout_.edge_m) < kBody_m)) continue;
    for (const std::int16_t member : members) cells_[static_cast<std::size_t>(member)].is_body = true;
  }
}

void BayFloor::look(const TrackedScan& tracked, std::size_t first, std::size_t last, std::uint32_t time_ds) {
  const PointsInMap in_bay{bay_from_map_ * tracked.estimate.map_from_robot};
  BeamEnds ends;
  for (std::size_t i = first; i < last; ++i) {
    std::optional<std::size_t> cell;
    const Point2 end = in_bay(tracked.rays[i].end);
    if (tracked.scan.beams[i].kind == BeamKind::kRange) cell = mark_beam(in_bay(tracked.rays[i].origin), end);
    if (!cell) {
      mark_faces(ends);
      continue;
    }
    ends.in_bay.push_back(end);
    ends.cells.push_back(*cell);
  }
  mark_faces(ends);
  take_marks(time_ds);
  find_bodies();
}

bool BayFloor::is_known(const FloorCell& cell, std::uint32_t time_ds, std::uint32_t window_ds) const {
  if (!cell.is_core || cell.seen_ds == 0 || time_ds - cell.seen_ds > window_ds) return false;
  return cell.evidence <= kFree || cell.is_body || (cell.evidence < kTaken && cell.shadows >= kShadowLooks);
}

FloorCounts BayFloor::counts(std::uint32_t time_ds, std::uint32_t window_ds) const {
  FloorCounts counts;
  counts.cells = core_cells_;
  std::uint32_t risen_ds = std::numeric_limits<std::uint32_t>::max();
  for (const FloorCell& cell : cells_) {
    if (cell.is_risen && cell.is_body) risen_ds = std::min(risen_ds, cell.since_ds);
  }
  const bool has_risen = risen_ds != std::numeric_limits<std::uint32_t>::max();
  for (const FloorCell& cell : cells_) {
    counts.body = counts.body || cell.is_body;
    counts.risen += cell.is_risen && cell.is_body && cell.faces >= kFaceLooks ? 1 : 0;
    const bool is_recent = cell.seen_ds > 0 && time_ds - cell.seen_ds <= window_ds;
    counts.small += cell.is_core && is_recent && cell.evidence >= kTaken && !cell.is_body ? 1 : 0;
    if (!is_known(cell, time_ds, window_ds)) continue;
    if (cell.evidence <= kFree) {
      ++counts.free;
      counts.free_since += !has_risen || cell.free_ds >= risen_ds ? 1 : 0;
    } else if (cell.is_body) {
      ++counts.taken;
    } else {
      ++counts.shadowed;
    }
  }
  return counts;
}

std::uint32_t BayFloor::body_seen_ds() const {
  std::uint32_t on_floor_ds = 0;
  std::uint32_t on_rim_ds = 0;
  for (const FloorCell& cell : cells_) {
    if (!cell.is_body) continue;
    std::uint32_t& seen_ds = cell.is_core ? on_floor_ds : on_rim_ds;
    seen_ds = std::max(seen_ds, cell.seen_ds);
  }
  return on_floor_ds > 0 ? on_floor_ds : on_rim_ds;
}

std::uint32_t BayFloor::seen_since_ds(std::uint32_t time_ds, std::uint32_t window_ds, int least_cells) const {
  std::array<int, kMostWindow_ds + 1> seen{};  // by age
  const std::uint32_t most_ds = std::min(window_ds, kMostWindow_ds);
  for (const FloorCell& cell : cells_) {
    if (is_known(cell, time_ds, most_ds)) ++seen[time_ds - cell.seen_ds];
  }
  std::uint32_t age_ds = 0;
  for (int cells = seen[0]; cells < least_cells && age_ds < most_ds; cells += seen[age_ds]) ++age_ds;
  return time_ds - age_ds;
}

}  // namespace deltamap::mapping::bays
