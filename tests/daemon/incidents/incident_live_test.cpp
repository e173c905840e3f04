// SPDX-License-Identifier: Apache-2.0
// `ctl mark` in the running daemon, with all its threads.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "daemon/incidents/incident_list.hpp"
#include "tests/support/daemon/control_fixture.hpp"

namespace deltamap::daemon {
namespace {

using control::Request;
using Kind = Request::Kind;
using namespace std::chrono_literals;

class IncidentLiveTest : public test::ControlDeskTest {
 protected:
  IncidentLiveTest() { settings_.incidents.folder = folder_.path() / "incidents"; }

  RunReport replay_incident(const StoredIncident& stored, const std::string& out) {
    ReplayJob job;
    job.recording = stored.folder / kIncidentRecording;
    job.map = stored.folder / kIncidentMap;
    job.settings = read_settings(stored.folder / kIncidentSettings, {});
    job.out = folder_.path() / out;
    return run_replay(job, [](double) { return true; });
  }
};

TEST_F(IncidentLiveTest, AMarkIsKeptAndRepeatsAYoungRunBitForBit) {
  settings_.recording.file.clear();
  (void)run_live(3ms, [&](const Pipeline&) {
    ASSERT_TRUE(reached_scan(60));
    EXPECT_EQ(exit_code({"mark", "pallet", "fell"}), 0);
    const auto listed = asked({Kind::kIncidents, {}});
    ASSERT_EQ(listed["incidents"].size(), 1u) << listed;
    EXPECT_EQ(listed["incidents"][0]["words"], "marked by an operator: pallet fell");
    EXPECT_EQ(listed["incidents"][0]["complete"], false);
    EXPECT_EQ(exit_code({"incidents"}), 0);
    EXPECT_EQ(status()["outputs"]["incidents"]["written"], true);
  });
  const auto all = incidents_in(settings_.incidents.folder);
  ASSERT_EQ(all.size(), 1u);
  EXPECT_TRUE(all[0].incident.to) << "the run has ended before its half minute was over, and so does it";
  EXPECT_EQ(replay_incident(all[0], "replayed").journal, "obeyed");
  expect_same_files("live", "replayed");
}

TEST_F(IncidentLiveTest, WithoutAFolderAMarkIsRefusedWithWhatToSet) {
  settings_.incidents.folder.clear();
  (void)run_live(0ms, [&](const Pipeline&) {
    EXPECT_EQ(asked({Kind::kMark, {}})["error"],
              "'incidents.folder' is not set: nothing is kept (set it, and restart)");
    EXPECT_EQ(asked({Kind::kIncidents, {}})["error"],
              "'incidents.folder' is not set: nothing is kept (set it, and restart)");
  });
}

TEST_F(IncidentLiveTest, TwoDaemonsDoNotShareAFolder) {
  std::filesystem::create_directories(settings_.incidents.folder);
  const auto lock = lock_of_folder(settings_.incidents.folder);
  EXPECT_THROW((void)Pipeline(settings_, options()), FileInUse);
}

}  // namespace
}  // namespace deltamap::daemon
