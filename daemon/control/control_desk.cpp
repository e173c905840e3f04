// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/control_desk.hpp"

#include <optional>
#include <utility>

#include "daemon/control/status_report.hpp"
#include "drivers/port/port_clock.hpp"

namespace deltamap::daemon::control {

using control::done_line;
using control::error_line;
using control::Request;

namespace {

/// Of a request that the localization thread takes.
Command::Kind command_of(Request::Kind kind) {
  switch (kind) {
    case Request::Kind::kPause:
      return Command::Kind::kPause;
    case Request::Kind::kResume:
      return Command::Kind::kResume;
    case Request::Kind::kUndo:
      return Command::Kind::kUndo;
    case Request::Kind::kUndoThing:
      return Command::Kind::kUndoThing;
    case Request::Kind::kRollBack:
      return Command::Kind::kRollBack;
    case Request::Kind::kRelocalize:
      return Command::Kind::kRelocalize;
    default:
      return Command::Kind::kSave;
  }
}

}  // namespace

ControlDesk::ControlDesk(const Settings& settings, Wiring wiring)
    : settings_{settings},
      wiring_{std::move(wiring)},
      began_{drivers::port::port_clock_now()},
      server_{{.socket = settings.control.socket,
               .handle = [this](const std::string& line, bool sender_is_gone,
                                control::Server::Reply reply) { answer(line, sender_is_gone, std::move(reply)); },
               .late_reply = error_line("not answered yet: the daemon is busy, its log will say what became of it"),
               .patience_s = wiring_.patience_s}} {}

void ControlDesk::answer(const std::string& line, bool sender_is_gone, control::Server::Reply reply) {
  const control::RequestAnswer answer = control::request_of_line(line);
  if (!answer.request) return reply(error_line(answer.refused));
  const Request& request = *answer.request;
  const bool only_asks = request.kind == Request::Kind::kStatus || request.kind == Request::Kind::kIncidents ||
                         request.kind == Request::Kind::kThings || request.kind == Request::Kind::kBays;
  if (!only_asks) wiring_.log("ctl: " + control::words_of(request));
  if (sender_is_gone && request.kind == Request::Kind::kDriveWander) {
    return wiring_.log("ctl: drive wander: not done, who asked for it waits no longer");
  }
  switch (request.kind) {
    case Request::Kind::kStatus:
      return reply(status_json_line(wiring_.telemetry, settings_, seconds(drivers::port::port_clock_now() - began_)));
    case Request::Kind::kThings:
      return reply(wiring_.things());
    case Request::Kind::kBays:
      return reply(wiring_.bays());
    case Request::Kind::kDriveOff:
      return drive(false, request, std::move(reply));
    case Request::Kind::kDriveWander:
      return drive(true, request, std::move(reply));
    case Request::Kind::kReload:
      return reload(std::move(reply));
    case Request::Kind::kRecordStart:
      return await(request, std::move(reply), [this](auto ticket) { return wiring_.record(true, ticket); });
    case Request::Kind::kRecordStop:
      return await(request, std::move(reply), [this](auto ticket) { return wiring_.record(false, ticket); });
    case Request::Kind::kMark:
      return await(request, std::move(reply), [&](auto ticket) { return wiring_.mark(request.words, ticket); });
    case Request::Kind::kEditSite:
      return await(request, std::move(reply), [&](auto ticket) { return wiring_.draw(request.edit, ticket); });
    case Request::Kind::kIncidents:
      return reply(wiring_.incidents());
    case Request::Kind::kLogLevel:
      return reply(with_log_level(request.log_level));
    default:
      return command(request, std::move(reply));
  }
}

/// Logs the refusal behind the request that was logged when it came, and answers the client with the reason.
void ControlDesk::refuse(const Request& request, const std::string& why, const control::Server::Reply& reply) const {
  wiring_.log("ctl: " + control::words_of(request) + ": " + why);
  reply(error_line(why));
}

double ControlDesk::silence_s() {
  return pulse_.silence_s([this](auto work) { server_.post(std::move(work)); });
}

void ControlDesk::ask(std::string line, control::Server::Reply reply) {
  const Timestamp asked = drivers::port::port_clock_now();
  server_.post([this, asked, line = std::move(line), reply = std::move(reply)]() mutable {
    const bool is_old = seconds(drivers::port::port_clock_now() - asked) > wiring_.patience_s;
    answer(line, is_old, std::move(reply));
  });
}

void ControlDesk::drive(bool may_drive, const Request& request, control::Server::Reply reply) {
  const std::uint64_t ticket = next_ticket_++;
  waiting_.emplace(ticket, Waiting{request, std::move(reply)});
  wiring_.let_drive(may_drive, ticket);
}

void ControlDesk::await(const Request& request, control::Server::Reply reply,
                        const std::function<bool(std::uint64_t)>& send) {
  const std::uint64_t ticket = next_ticket_++;
  if (!send(ticket)) return refuse(request, "the disk is too slow: try again", reply);
  waiting_.emplace(ticket, Waiting{request, std::move(reply)});
}

/// One for all who ask meanwhile, behind whatever else has come: no order to stop waits for a queue of them.
void ControlDesk::reload(control::Server::Reply reply) {
  reloads_.push_back(std::move(reply));
  if (reloads_.size() > 1) return;
  server_.post([this] {
    const std::string line = reloaded();
    for (const control::Server::Reply& waiting : std::exchange(reloads_, {})) waiting(line);
  });
}

std::string ControlDesk::reloaded() const {
  const LiveSettings::Outcome outcome = wiring_.reload();
  std::string text;
  for (const std::string& line : outcome.lines) text += (text.empty() ? "" : "\n") + line;
  return outcome.done ? done_line(text) : error_line(text);
}

std::string ControlDesk::with_log_level(LogLevel level) const {
  if (!wiring_.set_log_level(level)) return error_line("the log of this run has no levels");
  return done_line("the log shows " + std::string(name_of(level)) + " and above until the next start");
}

void ControlDesk::command(const Request& request, control::Server::Reply reply) {
  const bool is_off_map = request.kind == Request::Kind::kRelocalize &&
                          !wiring_.map.contains(wiring_.map.cell_at(request.map_from_robot.position()));
  if (is_off_map) return refuse(request, "that pose lies outside the map", reply);
  const std::uint64_t ticket = next_ticket_++;
  if (!wiring_.commands.try_send(
          Command{command_of(request.kind), request.map_from_robot, request.revision, request.thing, ticket})) {
    return refuse(request, "too many commands wait already", reply);
  }
  waiting_.emplace(ticket, Waiting{request, std::move(reply)});
}

void ControlDesk::tell(const CommandOutcome& outcome) {
  server_.post([this, outcome] {
    const auto found = waiting_.find(outcome.ticket);
    if (found == waiting_.end()) return;
    wiring_.log("ctl: " + control::words_of(found->second.request) + ": " + outcome.message);
    found->second.reply(outcome.done ? done_line(outcome.message, outcome.doubt) : error_line(outcome.message));
    waiting_.erase(found);
  });
}

std::unique_ptr<ControlDesk> begun_control_desk(const Settings& settings, ControlDesk::Wiring wiring,
                                                const std::function<void(const std::string&)>& warn) {
  if (settings.control.socket.empty()) return nullptr;
  try {
    return std::make_unique<ControlDesk>(settings, std::move(wiring));
  } catch (const sockets::AlreadyServed&) {
    throw;
  } catch (const std::exception& error) {
    warn(std::string("no `deltamap ctl` in this run: ") + error.what());
    return nullptr;
  }
}

}  // namespace deltamap::daemon::control
