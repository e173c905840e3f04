// SPDX-License-Identifier: Apache-2.0
// Brings a map store of an older version up to date. Version 1 kept no pose covariance; version 2 kept names in a table
// of their own, and neither checksums nor copies of its rows.
#pragma once

#include "mapping/store/database.hpp"

namespace deltamap::mapping::store {

/// All or nothing. Throws StoreError where a revision cannot be restored: checksums would call it sound.
void bring_up_to_date(Database& database);

}  // namespace deltamap::mapping::store
