// SPDX-License-Identifier: Apache-2.0
#include "drivers/port/byte_record.hpp"

#include <charconv>

namespace deltamap::drivers::port {

std::optional<unsigned> baud_of_note(std::string_view note) {
  constexpr std::string_view kWord = "baud ";
  if (!note.starts_with(kWord)) return std::nullopt;
  note.remove_prefix(kWord.size());
  unsigned baud = 0;
  const auto [end, error] = std::from_chars(note.data(), note.data() + note.size(), baud);
  if (error != std::errc{} || end != note.data() + note.size() || baud == 0) return std::nullopt;
  return baud;
}

}  // namespace deltamap::drivers::port
