// SPDX-License-Identifier: Apache-2.0
#include "mapping/store/replaced_first_page.hpp"

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <string>
#include <system_error>

#include "mapping/store/database_log.hpp"
#include "mapping/store/store_schema.hpp"

namespace deltamap::mapping::store {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kPage = 4096;       // SQLite's, as long as nobody asks for another
constexpr std::size_t kPagesAt = 28;      // of the header, big endian (SQLite, "Database File Format", 1.3)
constexpr std::size_t kFreePagesAt = 32;  // first of them and number: they hold nothing
constexpr std::size_t kFreePagesSize = 8;
using Page = std::array<char, kPage>;

fs::path new_folder() {
  std::string name = fs::temp_directory_path() / "deltamap-store-XXXXXX";
  if (::mkdtemp(name.data()) == nullptr) {
    throw fs::filesystem_error("cannot be made", name, std::error_code(errno, std::generic_category()));
  }
  return name;
}

/// Of a store without a map.
Page first_page_in(const fs::path& folder) {
  const fs::path empty = folder / "empty";
  { const Database store = opened_store(empty, Database::Mode::kCreate); }
  Page page{};
  std::ifstream{empty, std::ios::binary}.read(page.data(), kPage);
  return page;
}

Page with_pages(Page page, std::uintmax_t pages) {
  for (std::size_t i = 0; i < 4; ++i) page.at(kPagesAt + i) = static_cast<char>(pages >> (24 - 8 * i));
  for (std::size_t i = 0; i < kFreePagesSize; ++i) page.at(kFreePagesAt + i) = 0;
  return page;
}

}  // namespace

ReplacedFirstPage::ReplacedFirstPage(const fs::path& store) : folder_{new_folder()} {
  try {
    fs::copy_file(store, file());
    fs::permissions(file(), fs::perms::owner_write, fs::perm_options::add);
    if (const fs::path log = log_of(store).log; fs::exists(log)) fs::copy_file(log, log_of(file()).log);
    const Page page = with_pages(first_page_in(folder_), fs::file_size(file()) / kPage);
    std::fstream{file(), std::ios::binary | std::ios::in | std::ios::out}.write(page.data(), kPage);
  } catch (...) {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
    throw;
  }
}

ReplacedFirstPage::~ReplacedFirstPage() {
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

}  // namespace deltamap::mapping::store
