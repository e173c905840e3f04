// SPDX-License-Identifier: Apache-2.0
// The files that a run has left in its folder (--out), read again.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "daemon/outputs/change_note.hpp"
#include "daemon/outputs/localization_log.hpp"
#include "daemon/settings/settings.hpp"

namespace deltamap::tool {

struct RunFolder {
  daemon::Settings settings;  ///< what decides about the page; as delivered where report.json does not tell
  std::vector<daemon::LocalizationRow> rows;
  std::vector<daemon::ChangeNote> changes;
  std::vector<std::string> notes;  ///< one line each: what is cut, or missing and can be done without
};

/// Reads localization.csv, changes.jsonl and report.json. Throws std::runtime_error: one line that names file and line.
/// The last line of a file may be cut: a run that is still going on, or a disk that was full.
[[nodiscard]] RunFolder read_run_folder(const std::filesystem::path& folder);

}  // namespace deltamap::tool
