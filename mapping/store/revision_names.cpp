// SPDX-License-Identifier: Apache-2.0
#include "mapping/store/revision_names.hpp"

#include <algorithm>

#include "mapping/store/guarded_rows.hpp"

namespace deltamap::mapping::store {
namespace {

constexpr std::size_t kLongestName = 80;  // bytes

bool is_one_line(const std::string& name) {
  return std::none_of(name.begin(), name.end(), [](char letter) {
    const auto byte = static_cast<unsigned char>(letter);
    return byte < 0x20 || byte == 0x7F;
  });
}

}  // namespace

void write_name(Database& database, std::int64_t map, std::uint32_t number, const std::string& name,
                std::span<const std::uint8_t> grid) {
  if (name.size() > kLongestName || !is_one_line(name)) {
    database.fail("a name is one line of at most " + std::to_string(kLongestName) + " bytes");
  }
  const std::string which = "map = " + std::to_string(map) + " AND refused = 0 AND number = " + std::to_string(number);
  Transaction all{database};
  if (!are_sound(database, Table::kRevision, which)) {
    database.fail_as_unsound("damaged: revision " + std::to_string(number) + " is not what was written");
  }
  Statement row{database, "UPDATE revision SET name = nullif(?, ''), grid = ifnull(grid, ?) WHERE " + which};
  row.bind(name).bind(name.empty() ? std::span<const std::uint8_t>{} : grid);
  row.step();
  guard(database, Table::kRevision, which);
  all.commit();
}

}  // namespace deltamap::mapping::store
