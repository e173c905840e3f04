// SPDX-License-Identifier: Apache-2.0
// The tables of a map store: makes them in a new file, and brings those of older versions up to date.
#pragma once

#include <filesystem>

#include "mapping/store/database.hpp"

namespace deltamap::mapping::store {

/// Throws StoreError where the file is no sound map store. What is read as it is must be up to date.
[[nodiscard]] Database opened_store(const std::filesystem::path& file, Database::Mode mode);

}  // namespace deltamap::mapping::store
