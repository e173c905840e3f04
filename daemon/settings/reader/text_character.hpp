// SPDX-License-Identifier: Apache-2.0
// The characters of a text that look like others: blanks and quotes that no reader takes for what they look like.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace deltamap::daemon {

struct TextCharacter {
  char32_t code = 0;
  std::size_t bytes = 1;
};

/// The UTF-8 character at `at`; nothing where there is none.
[[nodiscard]] std::optional<TextCharacter> character_at(std::string_view text, std::size_t at);

/// What to say of a blank that is none to YAML, "a non-breaking space (U+00A0)"; nothing for any other character.
[[nodiscard]] std::optional<std::string> unusual_blank(char32_t code);

/// “ ” „ ‘ ’ ‚ « »
[[nodiscard]] bool is_typographic_quote(char32_t code);

}  // namespace deltamap::daemon
