// SPDX-License-Identifier: Apache-2.0
// `ctl --json`: an object on standard output whatever goes wrong, and the exit code that it has anyway.
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <chrono>
#include <cstring>
#include <nlohmann/json.hpp>

#include "tests/support/files/temporary_folder.hpp"
#include "tests/support/files/tool_run.hpp"

namespace deltamap::tool {
namespace {

std::string error_of(const test::ToolRun& run) {
  const auto json = nlohmann::json::parse(run.output, nullptr, false);
  if (!json.is_object() || json.value("ok", true)) return "no error: " + run.output;
  return json.value("error", "");
}

TEST(CtlJson, WithoutADaemonTheErrorIsJson) {
  const test::TemporaryFolder folder;
  const std::string socket = folder.path() / "ctl.sock";
  for (const char* command : {"status", "pause", "reload"}) {
    const auto run = test::run_deltamap({"ctl", "--socket", socket, command, "--json"});
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_EQ(error_of(run), socket + ": no daemon listens there (No such file or directory)");
    EXPECT_EQ(run.errors, "deltamap: " + error_of(run) + "\n") << "a person reads it as before";
  }
}

TEST(CtlJson, MapSaveAsksWhatSaveAsks) {
  const test::TemporaryFolder folder;
  const std::string socket = folder.path() / "ctl.sock";
  const auto run = test::run_deltamap({"ctl", "--socket", socket, "map", "save", "--json"});
  EXPECT_EQ(run.exit_code, 1) << "the usage is right, the daemon is missing";
  EXPECT_EQ(error_of(run), socket + ": no daemon listens there (No such file or directory)");
  EXPECT_EQ(test::run_deltamap({"ctl", "map"}).exit_code, 2) << "map alone asks nothing";
}

TEST(CtlJson, WrongUsageIsJson) {
  for (const std::vector<std::string>& words : {std::vector<std::string>{"ctl", "--json"},
                                                {"ctl", "--json", "fly"},
                                                {"ctl", "drive", "sideways", "--json"},
                                                {"ctl", "relocalize", "here", "--json"}}) {
    const auto run = test::run_deltamap(words);
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_NE(error_of(run), "");
    EXPECT_EQ(error_of(run).find("no error"), std::string::npos) << run.output;
  }
  EXPECT_EQ(test::run_deltamap({"ctl", "fly"}).output, "");
}

TEST(CtlJson, AnUnknownCommandIsNamedWithTheNearest) {
  EXPECT_EQ(error_of(test::run_deltamap({"ctl", "--json", "stauts"})),
            "ctl: unknown command 'stauts' (nearest command status)");
  EXPECT_EQ(error_of(test::run_deltamap({"ctl", "foo", "--json"})), "ctl: unknown command 'foo'");
  EXPECT_EQ(error_of(test::run_deltamap({"ctl", "map", "sve", "--json"})),
            "ctl map: unknown command 'sve' (nearest command save)");
  EXPECT_EQ(error_of(test::run_deltamap({"ctl", "--json"})).substr(0, 34), "ctl: which command? status, pause,");
  EXPECT_EQ(test::run_deltamap({"calibrate"}).errors.substr(0, 34), "calibrate: which command? motion\nR");
  const auto top = test::run_deltamap({"replya", "x.pcapng"});
  EXPECT_EQ(top.exit_code, 2);
  EXPECT_EQ(top.errors.substr(0, top.errors.find('\n')), "unknown command 'replya' (nearest command replay)");
}

TEST(CtlJson, ADaemonThatDoesNotAnswerIsGivenUp) {
  const test::TemporaryFolder folder;
  const std::string path = folder.path() / "ctl.sock";
  const int listening = ::socket(AF_UNIX, SOCK_STREAM, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::memcpy(address.sun_path, path.data(), path.size());
  ASSERT_EQ(::bind(listening, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  ASSERT_EQ(::listen(listening, 1), 0);  // and never looks
  const auto began = std::chrono::steady_clock::now();
  const auto run = test::run_deltamap({"ctl", "--socket", path, "status", "--json"});
  EXPECT_LT(std::chrono::steady_clock::now() - began, std::chrono::seconds{60});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_EQ(error_of(run), path + ": the daemon does not answer");
  ::close(listening);
}

}  // namespace
}  // namespace deltamap::tool
