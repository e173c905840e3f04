// SPDX-License-Identifier: Apache-2.0
// The names that a person has given to revisions of a map store. A named revision is kept whole, so that it stays.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "mapping/store/database.hpp"

namespace deltamap::mapping::store {

/// `grid` is the encoded whole map of that revision. An empty name takes the name away; the map stays whole. Refused:
/// a name of more than 80 bytes, or of more than one line. Throws StoreError.
void write_name(Database& database, std::int64_t map, std::uint32_t number, const std::string& name,
                std::span<const std::uint8_t> grid);

}  // namespace deltamap::mapping::store
