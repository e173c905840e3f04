// SPDX-License-Identifier: Apache-2.0
#include "drivers/port/byte_record.hpp"

#include <charconv>

namespace deltamap::drivers::port {

namespace {

/// The number behind a word, where nothing follows it.
template <typename Number>
std::optional<Number> number_behind(std::string_view word, std::string_view note) {
  if (!note.starts_with(word)) return std::nullopt;
  note.remove_prefix(word.size());
  Number number{};
  const auto [end, error] = std::from_chars(note.data(), note.data() + note.size(), number);
  if (error != std::errc{} || end != note.data() + note.size()) return std::nullopt;
  return number;
}

}  // namespace

std::optional<unsigned> baud_of_note(std::string_view note) {
  const auto baud = number_behind<unsigned>("baud ", note);
  return baud && *baud > 0 ? baud : std::nullopt;
}

std::optional<Timestamp> end_of_note(std::string_view note) {
  const auto ns = number_behind<std::int64_t>("recording ends at ", note);
  return ns ? std::optional{timestamp_from_ns(*ns)} : std::nullopt;
}

}  // namespace deltamap::drivers::port
