// SPDX-License-Identifier: Apache-2.0
// What this process may do with a file or folder.
#pragma once

#include <fcntl.h>
#include <unistd.h>

#include <filesystem>

namespace deltamap {

/// `mode`: R_OK, W_OK, X_OK, together. As the user in whose name this runs; where it may not, errno says why.
[[nodiscard]] inline bool may_access(const std::filesystem::path& place, int mode) {
  return ::faccessat(AT_FDCWD, place.c_str(), mode, AT_EACCESS) == 0;
}

}  // namespace deltamap
