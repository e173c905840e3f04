// SPDX-License-Identifier: Apache-2.0
// Puts a file in the place of another in one step that survives a power cut: the old one or the new one is there, never
// half of one. All files that a run replaces go this way.
#pragma once

#include <filesystem>
#include <functional>
#include <string_view>

namespace deltamap {

/// Replaces a file whole: the old one stays until the new one is complete on disk. Its mode is kept, and its owner and
/// group where this process may give files away. Throws std::system_error that names the file.
void replace_file(const std::filesystem::path& file, std::string_view content);
/// The same for content that is not held in memory at once: `next_piece` answers it piece by piece, then an empty one.
void replace_file(const std::filesystem::path& file, const std::function<std::string_view()>& next_piece);

/// The same with mode, owner and group of `model`, another file or this one.
void write_file_like(const std::filesystem::path& model, const std::filesystem::path& file,
                     const std::function<std::string_view()>& next_piece);

/// Renames a finished file to its place: its content is on disk before its name, and the name before this returns.
/// Throws std::system_error that names the place.
void move_into_place(const std::filesystem::path& draft, const std::filesystem::path& file);

}  // namespace deltamap
