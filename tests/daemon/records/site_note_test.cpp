// SPDX-License-Identifier: Apache-2.0
#include "daemon/records/site_note.hpp"

#include <gtest/gtest.h>

#include "daemon/records/journal.hpp"

namespace deltamap::daemon {
namespace {

SetSite drawn_site(std::size_t zones) {
  Site site;
  for (std::size_t i = 0; i < zones; ++i) {
    const double x = static_cast<double>(i);
    site.zones.push_back({.id = "zone " + std::to_string(i),
                          .description = "a \"wall\"\nnobody may erase",
                          .kind = ZoneKind::kFrozen,
                          .polygon = {{x, 0.001}, {x + 0.9, 0.0}, {x, 7.123}}});
  }
  site.bays.push_back({.id = "B4", .polygon = {{1.0, 1.0}, {3.4, 1.0}, {3.4, 3.4}, {1.0, 3.4}}});
  return {41, timestamp_from_ns(1'700'000'000'123'456'789), std::make_shared<const Site>(std::move(site))};
}

TEST(SiteNote, SurvivesTheRecordingWhateverItsSize) {
  for (const std::size_t zones : {std::size_t{0}, std::size_t{1}, std::size_t{2000}}) {
    const SetSite set = drawn_site(zones);
    Journal journal;
    for (const std::string& note : notes_of(set)) journal.read(note);
    ASSERT_EQ(journal.commands().size(), 1u);
    const Decision& command = journal.commands()[0];
    EXPECT_EQ(command.kind, Decision::Kind::kSiteSet);
    EXPECT_EQ(command.scan, 41u);
    EXPECT_EQ(command.scan_time, set.scan_time);
    EXPECT_EQ(*command.site, *set.site);
  }
}

TEST(SiteNote, WithAPartMissingNothingIsTaken) {
  const std::vector<std::string> notes = notes_of(drawn_site(2000));
  ASSERT_GT(notes.size(), 1u);
  SetSiteReader reader;
  for (std::size_t i = 1; i < notes.size(); ++i) EXPECT_FALSE(reader.read(notes[i]));
}

}  // namespace
}  // namespace deltamap::daemon
