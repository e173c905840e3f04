// SPDX-License-Identifier: Apache-2.0
#include "daemon/live/pose_stream.hpp"

#include <nlohmann/json.hpp>

#include "daemon/telemetry/version.hpp"

namespace deltamap::daemon {
namespace {

constexpr int kPoseProtocol = 1;

std::string greeting() {
  const nlohmann::ordered_json hello{{"type", "hello"}, {"protocol", kPoseProtocol}, {"version", version_text()}};
  return hello.dump();
}

}  // namespace

PoseStream::PoseStream(const Settings& settings, const Telemetry& telemetry)
    : mapping_enabled_{settings.mapping.enabled},
      telemetry_{telemetry},
      lines_{{.socket = settings.poses.socket,
              .greeting = greeting(),
              .refusal = R"({"type":"refused","why":"too many clients"})",
              .next = [this]() -> std::optional<std::string> {
                const auto news = news_.try_receive();
                return news ? std::optional{pose_line(*news)} : std::nullopt;
              }}} {}

void PoseStream::show(const LocalizationRow& row, double latency_s) {
  if (!lines_.has_clients()) return;
  (void)news_.try_send({row, latency_s, gate_now(telemetry_, mapping_enabled_), {}, forbidden_by(telemetry_)});
  lines_.wake();
}

std::unique_ptr<PoseStream> begun_pose_stream(const Settings& settings, const Telemetry& telemetry,
                                              const std::function<void(const std::string&)>& warn) {
  if (settings.poses.socket.empty()) return nullptr;
  try {
    return std::make_unique<PoseStream>(settings, telemetry);
  } catch (const sockets::AlreadyServed&) {
    throw;
  } catch (const std::exception& error) {
    warn(std::string("no stream of poses in this run: ") + error.what());
    return nullptr;
  }
}

}  // namespace deltamap::daemon
