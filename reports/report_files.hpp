// SPDX-License-Identifier: Apache-2.0
// The look of a report: the files of page/, which the build puts into the program. Colours are those of the live page
// (daemon/dashboard/page/theme.css).
#pragma once

#include <span>

#include "daemon/dashboard/page_files.hpp"

namespace deltamap::reports {

[[nodiscard]] std::span<const daemon::dashboard::PageFile> page_files();

}  // namespace deltamap::reports
