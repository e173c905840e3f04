// SPDX-License-Identifier: Apache-2.0
// `deltamap incident` on what a daemon in virtual time has kept.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/support/daemon/incident_drive.hpp"
#include "tests/support/files/text_file.hpp"
#include "tests/support/files/tool_run.hpp"

namespace deltamap::tool {
namespace {

namespace fs = std::filesystem;
using test::run_deltamap;

class IncidentTool : public test::IncidentDrive {
 protected:
  void SetUp() override {
    start();
    drive(20.0);
    (void)mark("pallet fell");
    drive(32.0);
    stored_ = kept().front();
  }
  [[nodiscard]] std::string folder() const { return settings_.incidents.folder; }
  [[nodiscard]] const std::string& name() const { return stored_.incident.name; }

  daemon::StoredIncident stored_;
};

TEST_F(IncidentTool, ListsAndShowsWhatIsKept) {
  const auto listed = run_deltamap({"incident", "list", folder()});
  EXPECT_EQ(listed.exit_code, 0) << listed.errors;
  EXPECT_TRUE(listed.output.starts_with(name() + "  ")) << listed.output;
  EXPECT_TRUE(listed.output.ends_with("marked by an operator: pallet fell\n")) << listed.output;
  const auto json = nlohmann::json::parse(run_deltamap({"incident", "list", folder(), "--json"}).output);
  ASSERT_EQ(json.size(), 1u);
  EXPECT_EQ(json[0]["kind"], "mark");
  EXPECT_EQ(json[0]["complete"], true);
  const auto shown = run_deltamap({"incident", "--folder", folder(), "show", name()});
  EXPECT_EQ(shown.output, test::content_of(stored_.folder / daemon::kIncidentWords));
  EXPECT_NE(
      shown.output.find("recording.pcapng holds every byte of both devices from 27 s before the first event to 30 s"),
      std::string::npos)
      << shown.output;
}

TEST_F(IncidentTool, ReplaysAndTellsWhetherItMeetsTheSame) {
  const auto done = run_deltamap({"incident", "replay", stored_.folder.string()});
  EXPECT_EQ(done.exit_code, 0) << done.errors;
  EXPECT_EQ(done.output, "neither the live run nor the replay lost its pose (kept for: mark)\n");
}

TEST_F(IncidentTool, ReplaysWhereTheFilesOfItsBaysAndZonesAreNot) {
  const std::string settings = stored_.folder / daemon::kIncidentSettings;
  std::string text = test::content_of(settings);
  for (const std::string key : {"\nbays:\n  file: ", "\nzones:\n  file: "}) {
    const std::size_t at = text.find(key);
    ASSERT_NE(at, std::string::npos) << text;
    text.insert(at + key.size(), "/nowhere/site.yaml  # ");
  }
  std::ofstream{settings} << text;
  const auto done = run_deltamap({"incident", "replay", stored_.folder.string()});
  EXPECT_EQ(done.exit_code, 0) << done.errors;
}

TEST_F(IncidentTool, PacksOneFileThatTarReads) {
  const std::string tar = folder_.path() / "sent.tar";
  const auto packed = run_deltamap({"incident", "--folder", folder(), "pack", name(), "--out", tar});
  ASSERT_EQ(packed.exit_code, 0) << packed.errors;
  const std::string out = folder_.path() / "unpacked";
  fs::create_directories(out);
  ASSERT_EQ(std::system(("tar -xf " + tar + " -C " + out).c_str()), 0);
  for (const auto& entry : fs::directory_iterator(stored_.folder)) {
    const fs::path there = fs::path(out) / name() / entry.path().filename();
    EXPECT_EQ(test::content_of(there), test::content_of(entry.path())) << there;
    EXPECT_LE(std::abs((fs::last_write_time(there) - fs::last_write_time(entry.path())) / std::chrono::seconds{1}), 1);
  }
  EXPECT_EQ(daemon::read_incident(fs::path(out) / name()).events.size(), 1u);
}

TEST_F(IncidentTool, PacksNoneTwiceAndNoneOverAnotherOfItsName) {
  const std::string tar = folder_.path() / "sent.tar";
  const auto twice = run_deltamap({"incident", "--folder", folder(), "pack", name(), name() + "/", "--out", tar});
  EXPECT_EQ(twice.exit_code, 1);
  EXPECT_NE(twice.errors.find(name() + " is named twice"), std::string::npos) << twice.errors;
  const fs::path copy = folder_.path() / "elsewhere" / name();
  fs::create_directories(copy.parent_path());
  fs::copy(stored_.folder, copy);
  const auto both = run_deltamap({"incident", "pack", stored_.folder.string(), copy.string(), "--out", tar});
  EXPECT_EQ(both.exit_code, 1);
  EXPECT_NE(both.errors.find("named twice"), std::string::npos) << both.errors;
  EXPECT_FALSE(fs::exists(tar));
}

TEST_F(IncidentTool, TakesRelativeFoldersAndNamesWithASlash) {
  const fs::path here = fs::current_path();
  fs::current_path(folder_.path());
  const auto shown = run_deltamap({"incident", "--folder", "incidents", "show", name() + "/"});
  const auto packed = run_deltamap({"incident", "--folder", "incidents", "pack", name() + "/"});
  fs::current_path(here);
  EXPECT_EQ(shown.exit_code, 0) << shown.errors;
  EXPECT_EQ(packed.exit_code, 0) << packed.errors;
  EXPECT_TRUE(fs::exists(folder_.path() / (name() + ".tar")));
}

TEST_F(IncidentTool, NamesTheNearestOfAMisspeltName) {
  std::string misspelt = name();
  misspelt.back() = 'x';
  const auto run = run_deltamap({"incident", "--folder", folder(), "show", misspelt});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_NE(run.errors.find("holds no incident " + misspelt + " (nearest name " + name() + ")"), std::string::npos)
      << run.errors;
}

TEST_F(IncidentTool, PinsAndUnpins) {
  EXPECT_EQ(run_deltamap({"incident", "--folder", folder(), "pin", name()}).exit_code, 0);
  EXPECT_TRUE(kept().front().is_pinned);
  EXPECT_EQ(run_deltamap({"incident", "--folder", folder(), "unpin", name()}).exit_code, 0);
  EXPECT_FALSE(kept().front().is_pinned);
}

TEST_F(IncidentTool, WhatIsNoIncidentIsNamed) {
  const auto none = run_deltamap({"incident", "--folder", folder(), "show", "elsewhere"});
  EXPECT_EQ(none.exit_code, 1);
  EXPECT_EQ(none.errors, "deltamap: " + folder() +
                             ": holds no incident elsewhere (`deltamap incident list` names its 1 incident)\n");
  EXPECT_EQ(run_deltamap({"incident", "pack", folder()}).errors,
            "deltamap: " + folder() + ": is no incident: no incident.json\n");
  EXPECT_EQ(run_deltamap({"incident", "list", folder() + "/none"}).errors,
            "deltamap: " + folder() +
                "/none: is no folder: `deltamap incident list FOLDER` with the daemon's 'incidents.folder'\n");
}

}  // namespace
}  // namespace deltamap::tool
