// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace deltamap::tool {

/// What a command is about to write is neither what it reads nor what a running daemon has in use. Throws
/// std::runtime_error naming the file, FileInUse naming the daemon.
void require_output_beside(const std::filesystem::path& output, const std::filesystem::path& read);

/// A picture is written as PNG whatever its name says: another ending is refused. Throws std::runtime_error.
void require_png(const std::filesystem::path& output);

}  // namespace deltamap::tool
