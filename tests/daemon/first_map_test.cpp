// SPDX-License-Identifier: Apache-2.0
// What is told of M_0 before a run begins on it, by file name.
#include "daemon/first_map.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "core/files/grid_file.hpp"
#include "tests/support/files/source_tree.hpp"
#include "tests/support/files/temporary_folder.hpp"
#include "tests/support/files/text_file.hpp"

namespace deltamap::daemon {
namespace {

namespace fs = std::filesystem;

class FirstMapTest : public testing::Test {
 protected:
  /// All unknown but for free floor in the corner, with one post on it.
  [[nodiscard]] OccupancyGrid map_of(int side, int free_side, double resolution_m = 0.05) const {
    OccupancyGrid grid{{side, side, resolution_m, {0.0, 0.0}}};
    for (int row = 0; row < free_side; ++row) {
      for (int column = 0; column < free_side; ++column) grid.set({column, row}, CellState::kFree);
    }
    if (free_side > 0) grid.set({0, 0}, CellState::kOccupied);
    return grid;
  }
  [[nodiscard]] std::string complaint(const MemoryLimit& limit = {}) const {
    try {
      (void)read_first_map(file_, limit);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  }
  void write(const fs::path& file, const std::string& text) const {
    fs::create_directories(file.parent_path());
    std::ofstream(file) << text;
  }

  test::TemporaryFolder folder_;
  fs::path file_ = folder_.path() / "hall.yaml";
};

TEST_F(FirstMapTest, AGoodOneIsReadWithoutAWord) {
  write_grid(map_of(100, 50), file_);
  const FirstMap map = read_first_map(file_, memory_limit());
  EXPECT_EQ(map.grid, map_of(100, 50));
  EXPECT_TRUE(map.warnings.empty());
}

TEST_F(FirstMapTest, OneThatNeedsMoreMemoryThanThereMayBeIsRefusedWithBothFigures) {
  write_grid(map_of(1000, 960), file_);
  EXPECT_EQ(shown_cells(file_), 15u * 15u * 64u * 64u);
  EXPECT_EQ(complaint({.most_bytes = 20'000'000, .most_of = "MemoryMax of /x"}),
            file_.string() +
                ": 1000 x 1000 cells of 0.05 m need about 27 MB of memory, and there are 20 MB (MemoryMax of /x): crop "
                "the map, make its cells larger, or give it more memory");
  EXPECT_EQ(complaint({.most_bytes = 28'000'000, .most_of = "MemoryMax of /x"}), "");
}

TEST_F(FirstMapTest, ToldIsWhatARunNeedsAndWhatThereMayBe) {
  write_grid(map_of(1000, 960), file_);
  EXPECT_EQ(memory_text(file_, {.most_bytes = 128'000'000,
                                .most_of = "MemoryMax of /x",
                                .high_bytes = 96'000'000,
                                .high_of = "MemoryHigh of /x"}),
            "about 27 MB of 128 MB (MemoryMax of /x), slow from 96 MB (MemoryHigh of /x)");
  EXPECT_EQ(memory_text(file_, {}), "about 27 MB, no limit is known");
}

TEST_F(FirstMapTest, WhatIsUnknownNeedsNoMemory) {
  write_grid(map_of(4000, 100), file_);
  EXPECT_EQ(shown_cells(file_), 2u * 2u * 64u * 64u);
  EXPECT_EQ(complaint({.most_bytes = 30'000'000, .most_of = "MemoryMax of /x"}), "") << "77 MB if all of it were shown";
}

TEST_F(FirstMapTest, OneThatWouldBeSlowedDownIsWarnedOf) {
  write_grid(map_of(1000, 960), file_);
  const auto warnings = read_first_map(file_, {.most_bytes = 30'000'000,
                                               .most_of = "MemoryMax of /x",
                                               .high_bytes = 25'000'000,
                                               .high_of = "MemoryHigh of /x"})
                            .warnings;
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0], file_.string() +
                             ": 1000 x 1000 cells of 0.05 m need about 27 MB of memory, and there are 25 MB "
                             "(MemoryHigh of /x): it will be slow");
}

TEST_F(FirstMapTest, CoarseCellsAreWarnedOf) {
  write_grid(map_of(100, 50, 1.0), file_);
  EXPECT_EQ(read_first_map(file_, {}).warnings,
            std::vector{file_.string() + ": cells of 1 m are coarse: 0.05 to 0.1 m are usual"});
  write_grid(map_of(100, 50, 0.1), file_);
  EXPECT_TRUE(read_first_map(file_, {}).warnings.empty());
}

TEST_F(FirstMapTest, SwappedThresholdsAreWarnedOf) {
  write_grid(map_of(100, 50), file_);
  write(file_, "image: hall.pgm\nresolution: 0.05\norigin: [0, 0, 0]\noccupied_thresh: 0.196\nfree_thresh: 0.65\n");
  EXPECT_EQ(read_first_map(file_, {}).warnings,
            std::vector{file_.string() +
                        ": line 5: 'occupied_thresh' (0.196) lies below 'free_thresh' (0.65): are they swapped?"});
}

TEST_F(FirstMapTest, OneWithoutFloorIsRefusedByName) {
  write_grid(map_of(100, 0), file_);
  EXPECT_EQ(complaint(), file_.string() + ": has no free cell, nowhere could a robot be");
  write(file_, "image: hall.pgm\nresolution: 0.05\norigin: [0, 0, 0]\noccupied_thresh: 0\nfree_thresh: 0.65\n");
  EXPECT_EQ(complaint(),
            file_.string() +
                ": has no free cell, nowhere could a robot be; line 5: 'occupied_thresh' (0) lies below 'free_thresh' "
                "(0.65): are they swapped?");
}

TEST_F(FirstMapTest, OneWithoutWallsIsWarnedOf) {
  write_grid(OccupancyGrid{{100, 100, 0.05, {0.0, 0.0}}, CellState::kFree}, file_);
  const auto warnings = read_first_map(file_, {}).warnings;
  ASSERT_EQ(warnings.size(), 2u);
  EXPECT_EQ(warnings[0],
            file_.string() + ": nothing is unknown: what no robot has seen is not told from floor and walls");
  EXPECT_EQ(warnings[1], file_.string() + ": has no occupied cell, no beam can tell where the robot is");
}

TEST_F(FirstMapTest, WhatTheMachineHasTooLittleOfNowMayBeThereLater) {
  write_grid(map_of(1000, 960), file_);
  const MemoryLimit machine{.most_bytes = 20'000'000, .most_of = "free on this machine", .may_rise = true};
  EXPECT_THROW((void)read_first_map(file_, machine), MemoryShortage);
  MemoryLimit unit = machine;
  unit.may_rise = false;
  try {
    (void)read_first_map(file_, unit);
  } catch (const MemoryShortage&) {
    FAIL() << "a unit's limit stays";
  } catch (const std::runtime_error&) {
  }
}

TEST_F(FirstMapTest, OneThatTheServiceHasNoMemoryForIsToldOutsideOfItToo) {
  write_grid(map_of(1000, 960), file_);
  EXPECT_EQ(why_not_as_service(file_, {28'000'000, "MemoryMax of x"}), "");
  EXPECT_EQ(why_not_as_service(file_, {20'000'000, "MemoryMax of x"}),
            file_.string() +
                ": needs about 27 MB of memory, and the service may have 20 MB (MemoryMax of x): it would not start as "
                "a service; raise MemoryMax and MemoryHigh (sudo systemctl edit deltamap)");
  EXPECT_EQ(unit_memory_of("LoadState=loaded\nMemoryMax=200000000\n")->most_bytes, 200'000'000u);
  EXPECT_FALSE(unit_memory_of("LoadState=loaded\nMemoryMax=infinity\n"));
  EXPECT_FALSE(unit_memory_of("LoadState=loaded\nMemoryMax=18446744073709551615\n"));
  const std::string unit = test::content_of(test::source_path("systemd/deltamap.service"));
  EXPECT_NE(unit.find("\nMemoryMax=" + std::to_string(unit_memory_of("")->most_bytes >> 20) + "M\n"), std::string::npos)
      << "what is told without a unit is what is delivered";
}

TEST_F(FirstMapTest, ACutOrEmptyPictureIsRefusedBeforeAnythingElse) {
  write_grid(map_of(100, 50), file_);
  fs::resize_file(folder_.path() / "hall.pgm", 100);
  EXPECT_NE(complaint({.most_bytes = 1, .most_of = "nobody"}).find("cut short"), std::string::npos);
  fs::resize_file(folder_.path() / "hall.pgm", 0);
  EXPECT_NE(complaint().find("is empty"), std::string::npos);
}

TEST_F(FirstMapTest, TheLimitIsTheLowestOfMachineServiceAndWhatItLiesIn) {
  const fs::path root = folder_.path() / "root";
  EXPECT_EQ(memory_limit(root).most_bytes, UINT64_MAX) << "what cannot be read limits nothing";
  write(root / "proc/meminfo", "MemTotal:  2000000 kB\nMemAvailable:   1000000 kB\n");
  EXPECT_EQ(memory_limit(root).most_bytes, 1'024'000'000u);
  EXPECT_EQ(memory_limit(root).most_of, "free on this machine");
  EXPECT_TRUE(memory_limit(root).may_rise);
  write(root / "proc/self/cgroup", "1:name=systemd:/\n0::/system.slice/deltamap.service\n");
  write(root / "sys/fs/cgroup/system.slice/deltamap.service/memory.max", "max\n");
  write(root / "sys/fs/cgroup/system.slice/deltamap.service/memory.high", "96000000\n");
  write(root / "sys/fs/cgroup/system.slice/memory.max", "128000000\n");
  const MemoryLimit limit = memory_limit(root);
  EXPECT_EQ(limit.most_bytes, 128'000'000u);
  EXPECT_EQ(limit.most_of, "MemoryMax of /system.slice");
  EXPECT_FALSE(limit.may_rise);
  EXPECT_EQ(limit.high_bytes, 96'000'000u);
  EXPECT_EQ(limit.high_of, "MemoryHigh of /system.slice/deltamap.service");
}

}  // namespace
}  // namespace deltamap::daemon
