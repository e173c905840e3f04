// SPDX-License-Identifier: Apache-2.0
// Numbers as a report tells them.
#pragma once

#include <string>

namespace deltamap::reports {

/// Shortest text that tells the number to six digits; empty for NaN.
[[nodiscard]] std::string text_of(double number);

/// Three digits: what a reader takes in. Whole numbers are whole; "–" where there is nothing.
[[nodiscard]] std::string short_text(double number);
/// A text whose numbers with a decimal point have three digits.
[[nodiscard]] std::string shortened(const std::string& text);

}  // namespace deltamap::reports
