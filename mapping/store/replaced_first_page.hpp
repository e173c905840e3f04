// SPDX-License-Identifier: Apache-2.0
// A store whose first page is damaged cannot be opened, and all else in it may be whole: that page says what the file
// is and where its tables begin, which is the same in every store. A copy with the first page of an empty store.
#pragma once

#include <filesystem>

namespace deltamap::mapping::store {

class ReplacedFirstPage {
 public:
  /// Copies the file, and its log, to a place of its own. Throws std::filesystem::filesystem_error, StoreError.
  explicit ReplacedFirstPage(const std::filesystem::path& store);
  ~ReplacedFirstPage();
  ReplacedFirstPage(const ReplacedFirstPage&) = delete;
  ReplacedFirstPage& operator=(const ReplacedFirstPage&) = delete;

  [[nodiscard]] std::filesystem::path file() const { return folder_ / "store"; }

 private:
  std::filesystem::path folder_;
};

}  // namespace deltamap::mapping::store
