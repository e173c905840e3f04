// SPDX-License-Identifier: Apache-2.0
#include "daemon/dashboard/access.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <stdexcept>

#include "tests/support/files/temporary_folder.hpp"

namespace deltamap::daemon::dashboard {
namespace {

namespace fs = std::filesystem;

const std::string kToken = "0123456789abcdef-secret";

Request good_request() { return {.method = "GET", .path = "/", .query = "", .host = "127.0.0.1:8484"}; }

unsigned status_of(const Request& request, const std::string& token = "") {
  const auto refusal = refusal_of(request, {.token = token});
  return refusal ? refusal->status : 200;
}

TEST(DashboardAccess, KnowsWhatLeadsBeyondThisMachine) {
  EXPECT_EQ(is_loopback("127.0.0.1"), true);
  EXPECT_EQ(is_loopback("127.3.2.1"), true);
  EXPECT_EQ(is_loopback("::1"), true);
  EXPECT_EQ(is_loopback("0.0.0.0"), false);
  EXPECT_EQ(is_loopback("192.168.1.7"), false);
  for (const char* none : {"localhost", "", "127.0.0.1:80", "1.2.3", "robot.example"}) {
    EXPECT_EQ(is_loopback(none), std::nullopt) << none;
  }
}

TEST(DashboardAccess, OnlyGetIsAnswered) {
  for (const char* method : {"POST", "PUT", "DELETE", "HEAD", "OPTIONS", "PATCH", "get", ""}) {
    Request request = good_request();
    request.method = method;
    EXPECT_EQ(status_of(request), 405u) << method;
  }
}

// --- commands ---

Request good_command() {
  Request request = good_request();
  request.method = "POST";
  request.path = "/api/command";
  request.origin = "http://127.0.0.1:8484";
  request.content_type = "application/json";
  return request;
}

unsigned status_of_command(const Request& request, const std::string& token = "") {
  const auto refusal = refusal_of(request, {.token = token, .takes_commands = true});
  return refusal ? refusal->status : 200;
}

TEST(DashboardAccess, ACommandIsTakenWhereTheSettingsSaySoAndNowhereElse) {
  EXPECT_EQ(status_of_command(good_command()), 200u);
  EXPECT_EQ(status_of(good_command()), 403u) << "control is off";
  Request elsewhere = good_command();
  elsewhere.path = "/api/status";
  EXPECT_EQ(status_of_command(elsewhere), 405u);
}

TEST(DashboardAccess, OnlyPostIsACommand) {
  for (const char* method : {"GET", "PUT", "DELETE", "HEAD", "OPTIONS", "post", ""}) {
    Request request = good_command();
    request.method = method;
    EXPECT_EQ(status_of_command(request), 405u) << method;
  }
}

TEST(DashboardAccess, WhatAFormOfAnotherSiteCanSendIsNoCommand) {
  for (const char* type : {"", "text/plain", "application/x-www-form-urlencoded", "multipart/form-data; boundary=x",
                           "application/jsonp", "text/plain; application/json"}) {
    Request request = good_command();
    request.content_type = type;
    EXPECT_EQ(status_of_command(request), 415u) << type;
  }
  Request with_charset = good_command();
  with_charset.content_type = "application/json; charset=utf-8";
  EXPECT_EQ(status_of_command(with_charset), 200u);
  Request foreign = good_command();
  foreign.origin = "http://evil.example";
  EXPECT_EQ(status_of_command(foreign), 403u);
  Request rebound = good_command();
  rebound.host = "evil.example";
  EXPECT_EQ(status_of_command(rebound), 421u);
}

TEST(DashboardAccess, ACommandNeedsTheTokenAsEverythingDoes) {
  Request request = good_command();
  EXPECT_EQ(status_of_command(request, kToken), 401u);
  request.authorization = "Bearer " + kToken;
  EXPECT_EQ(status_of_command(request, kToken), 200u);
}

TEST(DashboardAccess, DrivingNeedsATokenAlsoOnThisMachine) {
  Request request = good_request();
  request.path = "/drive";
  EXPECT_EQ(status_of(request), 403u) << "control is off";
  EXPECT_EQ(status_of_command(request), 403u) << "no token is asked for";
  EXPECT_EQ(status_of_command(request, kToken), 401u);
  request.cookie = "deltamap_token=" + kToken;
  EXPECT_EQ(status_of_command(request, kToken), 200u);
}

TEST(DashboardAccess, HostsThatAreAddressesOrLocalhostAreAnswered) {
  for (const char* host :
       {"127.0.0.1", "127.0.0.1:8484", "localhost", "localhost:9000", "[::1]", "[::1]:8484", "192.168.1.7:8484"}) {
    Request request = good_request();
    request.host = host;
    EXPECT_EQ(status_of(request), 200u) << host;
  }
}

TEST(DashboardAccess, HostsThatAreNamesAreRefused) {
  for (const char* host : {"", "evil.example", "evil.example:8484", "localhost.evil.example", "127.0.0.1.evil.example",
                           "localhost:evil", "127.0.0.1:", "127.0.0.1:123456", "[::1", "[::1]x", "::1", "[127.0.0.1]",
                           "[localhost]", "127.0.0.1@evil.example", "127.0.0.1 ", "[]", "["}) {
    Request request = good_request();
    request.host = host;
    EXPECT_EQ(status_of(request), 421u) << host;
  }
}

TEST(DashboardAccess, OtherOriginsAreRefused) {
  Request request = good_request();
  request.origin = "http://127.0.0.1:8484";
  EXPECT_EQ(status_of(request), 200u);
  for (const char* origin : {"http://evil.example", "null", "https://127.0.0.1:8484", "http://127.0.0.1:8485",
                             "http://localhost:8484", "file://", "http://127.0.0.1:8484/"}) {
    request.origin = origin;
    EXPECT_EQ(status_of(request), 403u) << origin;
  }
}

TEST(DashboardAccess, ReadingOnThisMachineNeedsNoTokenAndCommandingDoes) {
  for (const char* host : {"127.0.0.1:8484", "localhost", "127.3.2.1", "[::1]:9000"}) {
    Request request = good_request();
    request.host = host;
    EXPECT_EQ(status_of(request, kToken), 401u) << "from another machine";
    request.is_from_loopback = true;
    EXPECT_EQ(status_of(request, kToken), 200u) << host;
    request.path = "/live";
    EXPECT_EQ(status_of(request, kToken), 200u) << host;
    request.path = "/drive";
    EXPECT_EQ(status_of_command(request, kToken), 401u) << host;
    request.origin = "http://evil.example";
    request.path = "/live";
    EXPECT_EQ(status_of(request, kToken), 403u) << host;
  }
  Request command = good_command();
  command.is_from_loopback = true;
  EXPECT_EQ(status_of_command(command, kToken), 401u);
}

TEST(DashboardAccess, WhoMayReadWithoutTheTokenMayStop) {
  const Guard guard{.token = kToken, .takes_commands = true};
  Request command = good_command();
  EXPECT_FALSE(may_stop(command, guard)) << "from another machine";
  command.is_from_loopback = true;
  EXPECT_TRUE(may_stop(command, guard));
  EXPECT_FALSE(may_stop(command, {.token = kToken, .takes_commands = false}));
  const auto with = [&command](auto change) {
    Request changed = command;
    change(changed);
    return changed;
  };
  EXPECT_FALSE(may_stop(with([](Request& r) { r.host = "192.168.1.7:8484"; }), guard)) << "through a proxy";
  EXPECT_FALSE(may_stop(with([](Request& r) { r.host = "evil.example"; }), guard));
  EXPECT_FALSE(may_stop(with([](Request& r) { r.origin = "http://evil.example"; }), guard));
  EXPECT_FALSE(may_stop(with([](Request& r) { r.content_type = "text/plain"; }), guard)) << "a form of another site";
  EXPECT_FALSE(may_stop(with([](Request& r) { r.method = "GET"; }), guard));
  EXPECT_FALSE(may_stop(with([](Request& r) { r.path = "/drive"; }), guard));
}

TEST(DashboardAccess, ReadingByAnAddressBeyondThisMachineNeedsTheTokenFromAnywhere) {
  for (const char* host : {"192.168.1.7:8484", "0.0.0.0", "[fe80::1]"}) {
    Request request = good_request();
    request.host = host;
    request.is_from_loopback = true;
    EXPECT_EQ(status_of(request, kToken), 401u) << host;
  }
}

TEST(DashboardAccess, TheTokenIsAskedForEverywhereElse) {
  Request request = good_request();
  EXPECT_EQ(status_of(request, kToken), 401u);
  for (const std::string& wrong :
       {std::string{}, std::string{"x"}, kToken + "x", kToken.substr(1), std::string{"0123456789abcdef-secreT"}}) {
    request.authorization = "Bearer " + wrong;
    request.cookie = "deltamap_token=" + wrong;
    EXPECT_EQ(status_of(request, kToken), 401u) << wrong;
  }
  request.authorization = "Bearer " + kToken;
  EXPECT_EQ(status_of(request, kToken), 200u);
  request.authorization = "Basic " + kToken;
  EXPECT_EQ(status_of(request, kToken), 401u);
  request.cookie = "a=b; deltamap_token=" + kToken + "; c=d";
  EXPECT_EQ(status_of(request, kToken), 200u);
}

TEST(DashboardAccess, TheTokenInTheAddressBecomesACookieThatNoScriptSees) {
  Request request = good_request();
  request.query = "token=" + kToken;
  const auto entry = entry_of(request, kToken);
  ASSERT_TRUE(entry);
  EXPECT_EQ(entry->status, 303u);
  EXPECT_EQ(entry->headers.at(0).second, "/");
  EXPECT_NE(entry->headers.at(1).second.find("HttpOnly; SameSite=Strict"), std::string::npos);
  EXPECT_FALSE(entry_of(request, "another-token-0123456789"));
  EXPECT_FALSE(entry_of(request, ""));
  request.host = "evil.example";
  EXPECT_FALSE(entry_of(request, kToken));
}

TEST(DashboardAccess, ComparesSecretsByAllTheirCharacters) {
  EXPECT_TRUE(is_same_secret("abc", "abc"));
  EXPECT_FALSE(is_same_secret("abd", "abc"));
  EXPECT_FALSE(is_same_secret("xbc", "abc"));
  EXPECT_FALSE(is_same_secret("ab", "abc"));
  EXPECT_FALSE(is_same_secret("", ""));
}

TEST(DashboardAccess, ReadsATokenThatOthersMayNotRead) {
  const test::TemporaryFolder folder;
  const auto file = folder.write("token", kToken + "\nmore\n");
  fs::permissions(file, fs::perms::owner_read | fs::perms::owner_write);
  EXPECT_EQ(read_token(file), kToken);
  fs::permissions(file, fs::perms::others_read, fs::perm_options::add);
  EXPECT_THROW((void)read_token(file), std::runtime_error);
}

TEST(DashboardAccess, RefusesTokensThatAreNone) {
  const test::TemporaryFolder folder;
  for (const char* content : {"", "short", "\n0123456789abcdef", "0123456789abcdef;x", "0123456789 abcdef"}) {
    const auto file = folder.write("token", content);
    fs::permissions(file, fs::perms::owner_read | fs::perms::owner_write);
    EXPECT_THROW((void)read_token(file), std::runtime_error) << content;
  }
  EXPECT_THROW((void)read_token(folder.path()), std::runtime_error);
  try {
    (void)read_token(folder.path() / "missing");
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("missing: no token: "), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace deltamap::daemon::dashboard
