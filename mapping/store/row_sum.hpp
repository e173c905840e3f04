// SPDX-License-Identifier: Apache-2.0
// The SQL function row_sum(…): a checksum over values of a row, by which a damaged row is known.
#pragma once

struct sqlite3;

namespace deltamap::mapping::store {

/// FNV-1a (64 bit) over type and content of each argument. For the statements of this connection alone: no table,
/// index or trigger of the file uses it, so that other programs can read the file.
void add_row_sum(sqlite3* connection);

}  // namespace deltamap::mapping::store
