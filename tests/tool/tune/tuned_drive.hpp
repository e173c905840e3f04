// SPDX-License-Identifier: Apache-2.0
// A short drive through a small room, recorded, with its map and its true way: what `deltamap sweep`, `compare` and
// `score` are run on.
#pragma once

#include <gtest/gtest.h>

#include <cstdio>
#include <string>
#include <vector>

#include "core/files/grid_file.hpp"
#include "core/geometry/angle.hpp"
#include "tests/support/files/temporary_folder.hpp"
#include "tests/support/files/text_file.hpp"
#include "tests/support/files/tool_run.hpp"
#include "tests/support/scans/scripted_drive.hpp"

namespace deltamap::test {

using Words = std::vector<std::string>;

class TunedDriveTest : public testing::Test {
 protected:
  TunedDriveTest() {
    write_drive(file("drive.log"), 6.0);
    write_grid(small_room(false), file("room.yaml"));
    EXPECT_EQ(run_deltamap({"import", "carmen", file("drive.log"), file("drive.pcapng")}).exit_code, 0);
    std::string reference = "# t x y theta\n";
    for (int scan = 0; scan * 0.106 < 6.0; ++scan) {
      const Pose2 pose = pose_on_drive(scan * 0.106);
      char line[96];
      (void)std::snprintf(line, sizeof line, "%.6f %.4f %.4f %.5f\n", 1e9 + scan * 0.106, pose.x, pose.y, pose.theta);
      reference += line;
    }
    (void)folder_.write("truth.txt", reference);
  }

  [[nodiscard]] std::string file(const std::string& name) const { return (folder_.path() / name).string(); }

  /// With the room, the start and the truth.
  [[nodiscard]] ToolRun run(const std::string& command, const Words& more) const {
    const Pose2 start = pose_on_drive(0.0);
    char pose[96];
    (void)std::snprintf(pose, sizeof pose, "%.3f,%.3f,%.1f", start.x, start.y, degrees(start.theta));
    Words words{command,           file("drive.pcapng"), "--map",           file("room.yaml"), "--reference",
                file("truth.txt"), "--initial-pose",     std::string{pose}, "--jobs",          "2"};
    words.insert(words.end(), more.begin(), more.end());
    return run_deltamap(words);
  }
  [[nodiscard]] ToolRun sweep(const Words& more) const {
    Words words{"--param", "localization.beams=20:60:2", "--seeds", "2", "--out", file("sweep")};
    words.insert(words.end(), more.begin(), more.end());
    return run("sweep", words);
  }
  [[nodiscard]] std::vector<std::string> lines_of_book() const {
    std::vector<std::string> lines;
    std::string text = content_of(file("sweep/runs.jsonl"));
    for (std::size_t end; (end = text.find('\n')) != std::string::npos; text.erase(0, end + 1))
      lines.push_back(text.substr(0, end));
    return lines;
  }

  TemporaryFolder folder_;
};

}  // namespace deltamap::test
