// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace deltamap::mapping::store {

/// What SQLite keeps beside a database while it is open, and leaves behind where a program was killed.
struct DatabaseLog {
  std::filesystem::path log;  ///< written, and not in the database yet
  std::filesystem::path index;
};

[[nodiscard]] inline DatabaseLog log_of(const std::filesystem::path& database) {
  return {database.string() + "-wal", database.string() + "-shm"};
}

}  // namespace deltamap::mapping::store
