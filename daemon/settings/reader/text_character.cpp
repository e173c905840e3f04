// SPDX-License-Identifier: Apache-2.0
#include "daemon/settings/reader/text_character.hpp"

#include <cstdio>

namespace deltamap::daemon {
namespace {

constexpr char32_t kLargest = 0x10FFFF;

struct Lead {
  std::size_t bytes;
  char32_t bits;      ///< those of the first byte
  char32_t smallest;  ///< that needs so many bytes
};

std::optional<Lead> lead_of(unsigned char byte) {
  if (byte < 0x80) return Lead{1, byte, 0};
  if (byte >= 0xC0 && byte < 0xE0) return Lead{2, byte & 0x1Fu, 0x80};
  if (byte >= 0xE0 && byte < 0xF0) return Lead{3, byte & 0x0Fu, 0x800};
  if (byte >= 0xF0 && byte < 0xF8) return Lead{4, byte & 0x07u, 0x10000};
  return std::nullopt;
}

}  // namespace

std::optional<TextCharacter> character_at(std::string_view text, std::size_t at) {
  const auto lead = lead_of(static_cast<unsigned char>(text[at]));
  if (!lead || at + lead->bytes > text.size()) return std::nullopt;
  char32_t code = lead->bits;
  for (std::size_t i = 1; i < lead->bytes; ++i) {
    const auto byte = static_cast<unsigned char>(text[at + i]);
    if ((byte & 0xC0u) != 0x80u) return std::nullopt;
    code = (code << 6) | (byte & 0x3Fu);
  }
  const bool is_surrogate = code >= 0xD800 && code <= 0xDFFF;
  if (code < lead->smallest || code > kLargest || is_surrogate) return std::nullopt;
  return TextCharacter{code, lead->bytes};
}

std::optional<std::string> unusual_blank(char32_t code) {
  const bool is_wide = (code >= 0x2000 && code <= 0x200A) || code == 0x205F || code == 0x3000;
  const bool is_invisible = (code >= 0x200B && code <= 0x200F) || code == 0x2060 || code == 0xFEFF;
  const bool ends_lines = code == 0x85 || code == 0x2028 || code == 0x2029;
  const bool is_non_breaking = code == 0xA0 || code == 0x202F;
  if (!is_wide && !is_invisible && !ends_lines && !is_non_breaking) return std::nullopt;
  char number[16];
  (void)std::snprintf(number, sizeof number, " (U+%04X)", static_cast<unsigned>(code));
  const char* name = is_non_breaking ? "a non-breaking space"
                     : is_invisible  ? "an invisible character"
                     : ends_lines    ? "a line separator"
                                     : "a wide space";
  return std::string(name) + number;
}

bool is_typographic_quote(char32_t code) { return (code >= 0x2018 && code <= 0x201F) || code == 0xAB || code == 0xBB; }

}  // namespace deltamap::daemon
