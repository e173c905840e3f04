// SPDX-License-Identifier: Apache-2.0
#include "daemon/live/page_commands.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "daemon/control/control_desk.hpp"
#include "daemon/control/request.hpp"
#include "daemon/dashboard/access.hpp"
#include "daemon/stages/io_stage.hpp"

namespace deltamap::daemon {
namespace {

using control::Request;
using dashboard::Answer;

constexpr const char* kJson = "application/json";
constexpr unsigned kDone = 200, kForbidden = 403, kNotDone = 409, kNobody = 503;

Answer answer_of(const std::string& line) {
  const auto json = nlohmann::json::parse(line, nullptr, false);
  const bool is_done = json.is_object() && json.value("ok", false);
  return {.status = is_done ? kDone : kNotDone, .type = kJson, .body = line + "\n"};
}

bool moves_the_robot(const std::string& line) {
  const auto request = control::request_of_line(line).request;
  return request && request->kind == Request::Kind::kDriveWander;
}

}  // namespace

PageControl page_control(control::ControlDesk* desk, IoStage& io) {
  PageControl control;
  if (desk != nullptr) {
    control.ask = [desk](std::string line, control::Server::Reply reply) {
      desk->ask(std::move(line), std::move(reply));
    };
  }
  control.hand = {.take = [&io](std::uint64_t who, auto answer) { io.take_by_hand(who, std::move(answer)); },
                  .drive = [&io](std::uint64_t who, const DriveCommand& command) { io.drive_by_hand(who, command); },
                  .let_go = [&io](std::uint64_t who) { io.let_go(who); }};
  return control;
}

Answer refused_command(unsigned status, const std::string& why) {
  return {.status = status, .type = kJson, .body = control::error_line(why) + "\n"};
}

void take_command(const PageControl& control, bool has_token, const dashboard::Request& request,
                  dashboard::Reply reply) {
  if (!control.ask) return reply(refused_command(kNobody, "no commands in this run: the control socket is not there"));
  if (!has_token && moves_the_robot(request.body)) {
    return reply(refused_command(kForbidden, std::string(dashboard::kDrivingNeedsToken)));
  }
  control.ask(request.body, [reply = std::move(reply)](const std::string& line) { reply(answer_of(line)); });
}

}  // namespace deltamap::daemon
