// SPDX-License-Identifier: Apache-2.0
// Whether a run can have its outputs where the settings say. A start asks before it touches anything, --check-config
// asks the same and stops there. Makes, changes and disturbs nothing.
#pragma once

#include <filesystem>
#include <string>

namespace deltamap::daemon {

struct Settings;

// Each throws FileInUse where another program has the place, StartError where only a person can mend it, and answers
// why the run would go on without the output for now; empty: nothing is in the way. The folder must be there.

/// Of a store that is there, not whether it is sound (store_opening).
[[nodiscard]] std::string judged_store_place(const std::filesystem::path& store);
/// Of a file that is begun anew or replaced: the recording, a map.
[[nodiscard]] std::string judged_file_place(const std::filesystem::path& name);
/// `out` is the folder of --out: neither M_0 nor maps of others may be overwritten there.
[[nodiscard]] std::string judged_out_place(const std::filesystem::path& out, const Settings& settings);

}  // namespace deltamap::daemon
