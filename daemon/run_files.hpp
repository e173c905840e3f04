// SPDX-License-Identifier: Apache-2.0
// What a pipeline writes into its folder, and what it hears of itself on the way.
#pragma once

#include <exception>
#include <utility>

#include "core/files/replace_file.hpp"
#include "daemon/pipeline.hpp"
#include "daemon/telemetry/log_tail.hpp"
#include "drivers/port/port_clock.hpp"

namespace deltamap::daemon {

[[nodiscard]] inline std::filesystem::path in_folder(const std::optional<std::filesystem::path>& folder,
                                                     const char* name) {
  return folder ? *folder / name : std::filesystem::path{};
}

/// What the stages log is heard by `tail`, too.
[[nodiscard]] inline Pipeline::Options with_warnings(Pipeline::Options options, LogTail& tail) {
  options.warn = heard_by(tail, &drivers::port::port_clock_now, options.warn ? options.warn : options.log, true);
  options.log = heard_by(tail, &drivers::port::port_clock_now, std::move(options.log), false);
  return options;
}

/// Writes the run's report; a failure is only a warning, because the run itself has ended well.
inline void write_report(const Pipeline::Options& options, const Settings& settings, const RunReport& report) {
  try {
    replace_file(*options.out / "report.json", json_text(report, options.live ? options.live->in_force() : settings));
  } catch (const std::exception& error) {
    options.warn(std::string("no report of this run: ") + error.what());
  }
}

}  // namespace deltamap::daemon
