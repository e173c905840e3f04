// SPDX-License-Identifier: Apache-2.0
#include "daemon/live/pose_stream.hpp"

#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "daemon/telemetry/version.hpp"

namespace deltamap::daemon {
namespace {

constexpr int kPoseProtocol = 1;

using StreamJson = nlohmann::ordered_json;
using Wish = sockets::LineStream::Wish;

// Kinds of lines; who says nothing gets the first one.
constexpr unsigned kPoses = 1, kThings = 2, kBays = 4;
constexpr std::pair<std::string_view, unsigned> kKinds[] = {{"poses", kPoses}, {"things", kThings}, {"bays", kBays}};

std::string greeting() {
  const StreamJson hello{{"type", "hello"}, {"protocol", kPoseProtocol}, {"version", version_text()}};
  return hello.dump();
}

/// {"want":["bays"]}
Wish wish_in(const std::string& line) {
  const auto json = StreamJson::parse(line, nullptr, false);
  const bool has_list = json.is_object() && json.contains("want") && json["want"].is_array();
  const StreamJson list = has_list ? json["want"] : StreamJson::array();
  unsigned kinds = 0;
  std::size_t known = 0;
  for (const auto& [name, kind] : kKinds) {
    for (const StreamJson& one : list) {
      if (!one.is_string() || one.get_ref<const std::string&>() != name) continue;
      kinds |= kind;
      ++known;
    }
  }
  if (kinds != 0 && known == list.size()) return {kinds, StreamJson{{"type", "wanted"}, {"want", list}}.dump()};
  return {0, R"({"type":"refused","why":"ask with {\"want\":[…]}: a list of poses, things, bays"})"};
}

/// The file's line behind the type that each line of the stream has.
std::string typed(std::string_view type, std::string_view line) {
  while (line.ends_with('\n')) line.remove_suffix(1);
  return "{\"type\":\"" + std::string(type) + "\"," + std::string(line.substr(1));
}

}  // namespace

PoseStream::PoseStream(const Settings& settings, const Telemetry& telemetry,
                       std::function<void(const std::string&)> warn)
    : mapping_enabled_{settings.mapping.enabled},
      telemetry_{telemetry},
      lines_{{.socket = settings.poses.socket,
              .greeting = greeting(),
              .refusal = R"({"type":"refused","why":"too many clients"})",
              .next = [this] { return next(); },
              .hear = &wish_in,
              .dropped = [warn = std::move(warn)] { warn("poses: a client reads too slowly and is disconnected"); }}} {}

std::optional<sockets::LineStream::Line> PoseStream::next() {
  using Line = sockets::LineStream::Line;
  if (const auto news = news_.try_receive()) return Line{.text = pose_line(*news), .kind = kPoses};
  const std::uint64_t lost = events_lost_.load(std::memory_order_relaxed);
  if (const std::uint64_t untold = lost - std::exchange(losses_told_, lost); untold > 0) {
    return Line{
        .text = StreamJson{{"type", "lost"}, {"events", untold}}.dump(), .kind = kThings | kBays, .is_soon_old = false};
  }
  const auto event = events_.try_receive();
  if (!event) return std::nullopt;
  const bool is_thing = event->kind == EventKind::kThing;
  return Line{
      .text = typed(is_thing ? "thing" : "bay", event->line), .kind = is_thing ? kThings : kBays, .is_soon_old = false};
}

void PoseStream::tell(EventKind kind, std::string line) {
  if (!lines_.has_clients()) return;
  if (!events_.try_send({kind, std::move(line)})) events_lost_.fetch_add(1, std::memory_order_relaxed);
  lines_.wake();
}

void PoseStream::show(const LocalizationRow& row, double latency_s) {
  if (!lines_.has_clients()) return;
  (void)news_.try_send({row, latency_s, gate_now(telemetry_, mapping_enabled_), {}, forbidden_by(telemetry_)});
  lines_.wake();
}

std::unique_ptr<PoseStream> begun_pose_stream(const Settings& settings, const Telemetry& telemetry,
                                              const std::function<void(const std::string&)>& warn) {
  if (settings.poses.socket.empty()) return nullptr;
  try {
    return std::make_unique<PoseStream>(settings, telemetry, warn);
  } catch (const sockets::AlreadyServed&) {
    throw;
  } catch (const std::exception& error) {
    warn(std::string("no stream of poses in this run: ") + error.what());
    return nullptr;
  }
}

}  // namespace deltamap::daemon
