// SPDX-License-Identifier: Apache-2.0
// The parts that every report's page has: one file that needs nothing from elsewhere, in the look of the live page.
#pragma once

#include <string>
#include <vector>

#include "daemon/settings/settings.hpp"

namespace deltamap::reports {

/// A cell of a table's row; the text is made harmless. `style`: a class of page/report.css, or null.
[[nodiscard]] std::string cell(const std::string& text, const char* kind = "td", const char* style = nullptr);
/// A table that scrolls by itself where the screen is too narrow; `rows` are HTML.
[[nodiscard]] std::string table_of(const std::string& name, const std::vector<std::string>& columns,
                                   const std::string& rows);
/// From the beginning to the title above the text, and what ends it.
[[nodiscard]] std::string page_begin(const std::string& title);
[[nodiscard]] std::string page_end();
/// "deltamap 0.1.0, commit fc42533; settings as delivered, but seed: 2."
[[nodiscard]] std::string provenance_text(const daemon::Settings& settings);

}  // namespace deltamap::reports
