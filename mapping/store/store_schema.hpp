// SPDX-License-Identifier: Apache-2.0
// The tables of a map store: makes them in a new file, and finds out whether a file is a sound store.
#pragma once

#include <filesystem>

#include "mapping/store/database.hpp"

namespace deltamap::mapping::store {

inline constexpr std::int64_t kSchemaVersion = 3;

/// Throws StoreError where the file is no sound map store: where any page or row of it is not what was written. One of
/// an older version is brought up to date.
[[nodiscard]] Database opened_store(const std::filesystem::path& file, Database::Mode mode);

/// In an empty database, within a transaction. The tables of a new file begin on the same pages in every file.
void make_tables(Database& database);
/// Says what the file is.
void mark_as_store(Database& database);

}  // namespace deltamap::mapping::store
