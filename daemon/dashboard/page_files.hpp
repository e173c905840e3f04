// SPDX-License-Identifier: Apache-2.0
// The files of page/, which the build puts into the program (cmake/embed_page.cmake).
#pragma once

#include <span>
#include <string_view>

namespace deltamap::daemon::dashboard {

struct PageFile {
  std::string_view name;  ///< "index.html"
  std::string_view type;  ///< for Content-Type
  std::string_view content;
};

[[nodiscard]] std::span<const PageFile> page_files();

}  // namespace deltamap::daemon::dashboard
