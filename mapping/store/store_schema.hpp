// SPDX-License-Identifier: Apache-2.0
// The tables of a map store: makes them in a new file, and brings those of older versions up to date.
#pragma once

#include <filesystem>

#include "mapping/store/database.hpp"

namespace deltamap::mapping::store {

/// `mode`: kCreate or kExisting. Throws StoreError where the file is no sound map store.
[[nodiscard]] Database opened_store(const std::filesystem::path& file, Database::Mode mode);

}  // namespace deltamap::mapping::store
