// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/request.hpp"

#include <gtest/gtest.h>

namespace deltamap::daemon::control {
namespace {

using Kind = Request::Kind;

TEST(Request, EveryRequestSurvivesTheSocket) {
  for (const Kind kind :
       {Kind::kStatus, Kind::kIncidents, Kind::kThings, Kind::kMark, Kind::kPause, Kind::kResume, Kind::kSave,
        Kind::kReload, Kind::kRecordStart, Kind::kRecordStop, Kind::kDriveOff, Kind::kDriveWander}) {
    const Request request{kind, {}};
    const RequestAnswer answer = request_of_line(line_of(request));
    ASSERT_TRUE(answer.request) << line_of(request) << answer.refused;
    EXPECT_EQ(*answer.request, request) << line_of(request);
  }
  const auto answer = request_of_line(line_of({Kind::kRelocalize, {-1.25, 2.5, radians(-90.0)}}));
  ASSERT_TRUE(answer.request) << answer.refused;
  EXPECT_EQ(answer.request->kind, Kind::kRelocalize);
  EXPECT_DOUBLE_EQ(answer.request->map_from_robot.x, -1.25);
  EXPECT_DOUBLE_EQ(answer.request->map_from_robot.y, 2.5);
  EXPECT_NEAR(answer.request->map_from_robot.theta, radians(-90.0), 1e-12);
  for (std::size_t i = 0; i < kLogLevelNames.size(); ++i) {
    const Request level{.kind = Kind::kLogLevel, .log_level = static_cast<LogLevel>(i)};
    const auto back = request_of_line(line_of(level));
    ASSERT_TRUE(back.request) << line_of(level) << back.refused;
    EXPECT_EQ(*back.request, level);
  }
  const Request mark{.kind = Kind::kMark, .words = "\"pallet\" fell, 3 °"};
  EXPECT_EQ(request_of_line(line_of(mark)).request, mark);
  for (const Kind kind : {Kind::kUndo, Kind::kRollBack}) {
    for (const std::uint32_t revision : {0u, 7u, 4294967295u}) {
      const Request order{.kind = kind, .revision = revision};
      const auto back = request_of_line(line_of(order));
      ASSERT_TRUE(back.request) << line_of(order) << back.refused;
      EXPECT_EQ(*back.request, order);
    }
  }
}

TEST(Request, AnUndoNamesARevisionOrAThing) {
  Request undo{Kind::kUndoThing, {}};
  undo.thing = 12;
  EXPECT_EQ(line_of(undo), R"({"command":"undo","thing":12})");
  EXPECT_EQ(request_of_line(line_of(undo)).request, undo);
  EXPECT_EQ(words_of(undo), "undo thing 12");
  for (const char* line : {R"({"command":"undo","thing":-1})", R"({"command":"undo","thing":"12","revision":7})"})
    EXPECT_EQ(request_of_line(line).refused, "'undo' of a thing needs its id: 1, 2 …") << line;
}

TEST(Request, ABayOrZoneComesWithTheVersionOfItsList) {
  const std::string place = R"({"zoneId":"gate","vertices":[[4.0,4.0],[6.0,4.0],[6.0,6.0]]})";
  const auto edit = [](PlaceKind kind, const std::string& of, const std::string& what) {
    Request request{Kind::kEditSite, {}};
    request.edit = {kind, "00ff", of, what};
    return request;
  };
  const std::vector<std::pair<Request, std::string>> edits{
      {edit(PlaceKind::kZone, "", place), "zone drawn"},
      {edit(PlaceKind::kZone, "gate", place), "zone 'gate' changed"},
      {edit(PlaceKind::kBay, "B4", ""), "bay 'B4' taken away"}};
  for (const auto& [request, words] : edits) {
    EXPECT_EQ(request_of_line(line_of(request)).request, request) << line_of(request);
    EXPECT_EQ(words_of(request), words);
  }
  EXPECT_EQ(line_of(edits[2].first), R"({"command":"bay","version":"00ff","of":"B4"})");
  for (const char* line :
       {R"({"command":"zone","place":{}})", R"({"command":"zone","version":"00ff"})",
        R"({"command":"bay","version":7,"of":"B4"})", R"({"command":"bay","version":"1","place":[]})",
        R"({"command":"bay","version":"1","of":"B4","place":"B4"})"})
    EXPECT_EQ(request_of_line(line).refused, "a bay or zone needs version, and place or of") << line;
}

TEST(Request, WhatIsWrongIsSaidInOneLine) {
  const auto refusal = [](const std::string& line) {
    const RequestAnswer answer = request_of_line(line);
    EXPECT_FALSE(answer.request) << line;
    EXPECT_EQ(answer.refused.find('\n'), std::string::npos);
    return answer.refused;
  };
  for (const char* garbage : {"", "status", "[]", "42", "{", "{\"command\":\"stat", "\xFF\xFE", "null", "[[[[[["}) {
    EXPECT_EQ(refusal(garbage), "a request is one JSON object in one line") << garbage;
  }
  EXPECT_EQ(refusal("{}"), "a request needs a command");
  EXPECT_EQ(refusal(R"({"command":7})"), "a request needs a command");
  EXPECT_EQ(refusal(R"({"command":"explode"})"), "unknown command 'explode'");
  for (const char* pose : {R"({"command":"relocalize"})", R"({"command":"relocalize","x_m":1,"y_m":2})",
                           R"({"command":"relocalize","x_m":"1","y_m":2,"heading_deg":3})",
                           R"({"command":"relocalize","x_m":1e300,"y_m":2,"heading_deg":3})"}) {
    EXPECT_EQ(refusal(pose), "'relocalize' needs the numbers x_m, y_m and heading_deg") << pose;
  }
  for (const char* revision :
       {R"({"command":"undo"})", R"({"command":"undo","revision":-1})", R"({"command":"undo","revision":"7"})",
        R"({"command":"undo","revision":1.5})", R"({"command":"undo","revision":4294967296})"}) {
    EXPECT_EQ(refusal(revision), "'undo' needs the number of a revision: 0, 1, 2 …") << revision;
  }
  for (const char* level : {R"({"command":"log-level"})", R"({"command":"log-level","level":"off"})",
                            R"({"command":"log-level","level":2})", R"({"command":"log-level","level":"INFO"})"}) {
    EXPECT_EQ(refusal(level), "'log-level' needs the level trace, debug, info, warn or error") << level;
  }
  EXPECT_EQ(refusal(R"({"command":"record"})"), "'record' needs the mode start or stop");
  EXPECT_EQ(refusal(R"({"command":"record","mode":1})"), "'record' needs the mode start or stop");
  for (const std::string& words : {std::string("1"), std::string("\"two\\nlines\""), '"' + std::string(401, 'a') + '"'})
    EXPECT_EQ(refusal(R"({"command":"mark","words":)" + words + "}"),
              "'mark' needs words: one line of at most 400 bytes");
  EXPECT_EQ(refusal(R"({"command":"drive"})"), "'drive' needs the mode off or wander");
  EXPECT_EQ(refusal(R"({"command":"drive","mode":"patrol"})"), "'drive' needs the mode off or wander");
}

TEST(Request, ARepliedTextIsOneLineOfJsonWhateverItHolds) {
  EXPECT_EQ(done_line("a \"map\""), R"({"ok":true,"message":"a \"map\""})");
  EXPECT_EQ(done_line("only 6 %", true), R"({"ok":true,"message":"only 6 %","doubt":true})");
  EXPECT_EQ(error_line("two\nlines"), R"({"ok":false,"error":"two\nlines"})");
  EXPECT_EQ(error_line("\xFF").find('\xFF'), std::string::npos);
}

TEST(Request, IsLoggedAsAPersonWouldTypeIt) {
  EXPECT_EQ(words_of({Kind::kRelocalize, {1.0, -2.0, radians(90.0)}}), "relocalize 1.00,-2.00,90");
  EXPECT_EQ(words_of({Kind::kDriveOff, {}}), "drive off");
  EXPECT_EQ(words_of({.kind = Kind::kRollBack, .revision = 3}), "rollback 3");
  EXPECT_EQ(words_of({Kind::kSave, {}}), "save");
  EXPECT_EQ(words_of({.kind = Kind::kMark, .words = "pallet fell"}), "mark \"pallet fell\"");
  EXPECT_EQ(words_of({Kind::kMark, {}}), "mark");
}

}  // namespace
}  // namespace deltamap::daemon::control
