// SPDX-License-Identifier: Apache-2.0
// What the stages show of themselves for the live page: the newest of each, and a bounded past. No stage ever waits
// here for the page; with nobody viewing, a scan costs one look at a flag, and one scan a second is copied.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "core/messages.hpp"
#include "core/transient_obstacles.hpp"
#include "daemon/live/live_figures.hpp"
#include "daemon/outputs/change_note.hpp"
#include "daemon/outputs/localization_log.hpp"
#include "localization/particles/particle_set.hpp"
#include "mapping/store_scan.hpp"

namespace deltamap::daemon {

/// Is it time again for what is done once a period? Also where the clock has fallen back.
[[nodiscard]] inline bool is_due(Timestamp last, Timestamp now, double period_s) {
  return now < last || seconds(now - last) >= period_s;
}

/// Where a beam ended, in the robot's frame at the scan's time, cm.
struct LiveBeam {
  std::int16_t x_cm = 0;
  std::int16_t y_cm = 0;
};

/// Where the beams of a scan ended that brought back a range.
[[nodiscard]] std::vector<LiveBeam> beams_of(const TrackedScan& tracked);

/// The newest localized scan.
struct LiveScan {
  std::uint64_t number = 0;  ///< counts what was shown, from 1; 0: nothing yet
  LocalizationRow row;
  double latency_s = 0.0;        ///< from the scan's last byte to its pose
  std::vector<LiveBeam> beams;   ///< those that brought back a range
  std::vector<Pose2> particles;  ///< a few for all (localization/particles/particle_sample.hpp); none where they rest
};

/// About a second of a run, for path and charts.
struct LiveSample {
  enum Column : std::uint8_t {
    kX,  ///< m, as kY
    kY,
    kWAvg,
    kWFast,
    kWSlow,
    kRD,
    kNEff,
    kPoseRight,
    kMapWrong,
    kScansPerSecond,
    kLatency,  ///< ms
    kCpuIo,    ///< percent of one processor, as the next five
    kCpuLocalization,
    kCpuDelta,
    kCpuMap,
    kCpuRecorder,
    kCpuPage,
    kMemory,         ///< MiB, resident
    kWheelDistance,  ///< percent driven beyond what the wheels count
    kWheelTurn,      ///< percent turned beyond what the wheels count
    kColumns
  };
  Timestamp time;
  std::array<float, kColumns> values{};
};

class LiveBoard {
 public:
  static constexpr std::size_t kSamplesKept = 3600;  ///< an hour
  static constexpr std::size_t kChangesKept = 500;
  static constexpr std::size_t kBoxesKept = 256;  ///< of changed cells: who has missed more needs the whole map

  /// How much of the past.
  struct Kept {
    std::size_t samples = kSamplesKept;
    std::size_t changes = kChangesKept;
  };

  LiveBoard(std::shared_ptr<const OccupancyGrid> map, std::uint32_t revision, const Kept& kept);
  LiveBoard(std::shared_ptr<const OccupancyGrid> map, std::uint32_t revision)
      : LiveBoard{std::move(map), revision, Kept{}} {}

  /// Localization thread. Shows nothing where the page is just looking: the next scan comes soon.
  /// `particles` may be null: the pose does not rest on them.
  void show(const TrackedScan& tracked, const LocalizationRow& row, double latency_s,
            const localization::particles::ParticleSet* particles = nullptr);
  /// Delta thread, where somebody watches; not taken where the page is just looking: the next scan comes soon.
  void show(mapping::StoredScans stored);
  [[nodiscard]] bool is_watched() const { return is_watched_.load(std::memory_order_relaxed); }
  /// Delta thread. False: not taken, to be offered again at the next scan. Null: nothing is known.
  [[nodiscard]] bool show(const std::shared_ptr<const TransientObstacles>& transients);
  /// Map thread. `revision` may be null: refused.
  void show(const MapRevision* revision, const ChangeNote& note);

  /// Before the first scan: asked once for each sample, in the localization thread.
  void set_figures(std::function<LiveFigures()> figures);

  // --- the page's thread ---

  /// Whether anybody views: every scan is kept for the page only then, and what it holds of others is let go after.
  void watch(bool is_watched);

  /// Items in a row. They are counted from the start of the run: what lies before `first` has been forgotten.
  template <typename Item>
  struct Past {
    std::uint64_t first = 0;
    std::vector<Item> items;
    [[nodiscard]] std::uint64_t next() const { return first + items.size(); }
  };
  struct Map {
    std::shared_ptr<const OccupancyGrid> grid;
    std::uint32_t revision = 0;
    Past<CellBox> changed;
  };
  /// The newest map, and the boxes of cells that have changed since, from number `from` on.
  [[nodiscard]] Map map(std::uint64_t from = 0) const;
  /// Copies the newest scan over an older one; false where there is no newer one.
  bool fetch(LiveScan& scan) const;
  [[nodiscard]] std::shared_ptr<const TransientObstacles> transients() const;
  [[nodiscard]] mapping::StoredScans stored() const;
  /// At most `most` items, the oldest first.
  [[nodiscard]] Past<LiveSample> samples_from(std::uint64_t number, std::size_t most) const;
  [[nodiscard]] Past<ChangeNote> changes_from(std::uint64_t number, std::size_t most) const;
  /// Of all changes since the start, the forgotten ones too.
  struct ChangeCounts {
    std::uint64_t accepted = 0;
    std::uint64_t refused = 0;
  };
  [[nodiscard]] ChangeCounts change_counts() const;

 private:
  /// The newest `capacity` of many.
  template <typename Item>
  class Ring {
   public:
    explicit Ring(std::size_t capacity) : capacity_{capacity} { items_.reserve(std::min(capacity, kReserved)); }
    void add(const Item& item);
    [[nodiscard]] Past<Item> from(std::uint64_t number, std::size_t most) const;

   private:
    static constexpr std::size_t kReserved = kSamplesKept;
    std::size_t capacity_;
    std::uint64_t count_ = 0;
    std::vector<Item> items_;  // item n at n modulo capacity
  };

  void keep_scan(const TrackedScan& tracked, const LocalizationRow& row, double latency_s);
  void keep_sample(const LocalizationRow& row, double latency_s);
  void add_figures(LiveSample& sample, double passed_s);

  std::atomic<bool> is_watched_{false};
  mutable std::mutex mutex_;
  LiveScan scan_;
  std::uint64_t scans_seen_ = 0;  // localization thread alone, as the next two
  std::uint64_t scans_at_sample_ = 0;
  Timestamp last_sample_;
  std::function<LiveFigures()> figures_ = [] { return LiveFigures{}; };
  LiveFigures figures_at_sample_;
  std::shared_ptr<const TransientObstacles> transients_;
  mapping::StoredScans stored_;  // nothing while nobody watches
  std::shared_ptr<const OccupancyGrid> map_;
  std::uint32_t revision_;
  Ring<CellBox> boxes_{kBoxesKept};
  Ring<LiveSample> samples_;
  Ring<ChangeNote> changes_;
  ChangeCounts change_counts_;
};

}  // namespace deltamap::daemon
