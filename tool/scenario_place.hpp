// SPDX-License-Identifier: Apache-2.0
// Where the delivered scenarios lie: config/scenarios of the source tree, or the folder they were installed into.
#pragma once

#include <filesystem>
#include <string>

namespace deltamap::tool {

/// config/scenarios where the present folder has it, else that of the source tree that `program` was built in, else the
/// installed folder.
[[nodiscard]] std::filesystem::path scenario_folder(const std::filesystem::path& program);
/// Of the program that runs.
[[nodiscard]] std::filesystem::path scenario_folder();

/// `given` where it names a file or has a folder or an ending; a bare word such as "demo" names a delivered scenario.
/// Throws std::runtime_error with the names of all where there is none of that name.
[[nodiscard]] std::filesystem::path scenario_file(const std::string& given);

}  // namespace deltamap::tool
