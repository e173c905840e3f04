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
constexpr std::string_view kDrawingNeedsToken = "what changes where the robot drives needs 'dashboard.token_file'";
constexpr unsigned kDone = 200, kForbidden = 403, kNotDone = 409, kNobody = 503;

Answer answer_of(const std::string& line) {
  const auto json = nlohmann::json::parse(line, nullptr, false);
  const bool is_done = json.is_object() && json.value("ok", false);
  return {.status = is_done ? kDone : kNotDone, .type = kJson, .body = line + "\n"};
}

/// Why it is not taken where the page asks for no token; empty: it is.
std::string_view needs_token(const std::string& line) {
  const auto request = control::request_of_line(line).request;
  if (!request) return {};
  if (request->kind == Request::Kind::kDriveWander) return dashboard::kDrivingNeedsToken;
  return request->kind == Request::Kind::kEditSite ? kDrawingNeedsToken : std::string_view{};
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
  const std::string_view why = has_token ? std::string_view{} : needs_token(request.body);
  if (!why.empty()) return reply(refused_command(kForbidden, std::string(why)));
  control.ask(request.body, [reply = std::move(reply)](const std::string& line) { reply(answer_of(line)); });
}

}  // namespace deltamap::daemon
