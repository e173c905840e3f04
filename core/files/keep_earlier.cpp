// SPDX-License-Identifier: Apache-2.0
#include "core/files/keep_earlier.hpp"

#include <string>
#include <system_error>
#include <utility>

#include "core/files/file_lock.hpp"
#include "core/files/replace_file.hpp"
#include "core/utc_text.hpp"

namespace deltamap {
namespace {

/// "zones.20261130T110000Z.yaml", which is not there yet.
std::filesystem::path place_of_earlier(const std::filesystem::path& file, Timestamp now) {
  for (int number = 1;; ++number) {
    std::filesystem::path place = file;
    place.replace_extension("." + utc_name(now) + (number == 1 ? "" : "-" + std::to_string(number)) +
                            file.extension().string());
    std::error_code error;
    if (!std::filesystem::exists(place, error)) return place;
  }
}

}  // namespace

std::filesystem::path replace_and_keep(const std::filesystem::path& file, std::string_view before,
                                       std::string_view text, Timestamp now) {
  const std::filesystem::path place = file_behind(file);
  std::filesystem::path kept = place_of_earlier(place, now);
  write_file_like(place, kept, [&] { return std::exchange(before, {}); });
  try {
    replace_file(place, text);
  } catch (const std::system_error&) {
    std::error_code ignored;
    std::filesystem::remove(kept, ignored);
    throw;
  }
  return kept;
}

}  // namespace deltamap
