// SPDX-License-Identifier: Apache-2.0
// Which program this is: what --version prints, what the log begins with, and what stands in every report and table.
#pragma once

#include <string>
#include <string_view>

namespace deltamap::daemon {

/// "0.1.0"
[[nodiscard]] std::string_view version();
/// Of the source it was built from: "fc42533", "fc42533-dirty" with changes that are not committed, or "unknown".
[[nodiscard]] std::string_view commit();
/// "0.1.0 (commit fc42533, GCC 12.2.0, 64 bit)"
[[nodiscard]] std::string version_text();

}  // namespace deltamap::daemon
