// SPDX-License-Identifier: Apache-2.0
#include "daemon/records/note_parts.hpp"

#include <cstdio>

#include "core/base64.hpp"
#include "daemon/settings/fingerprint.hpp"

namespace deltamap::daemon {
namespace {

constexpr std::size_t kPartChars = 60'000;  // a pcapng option holds 65535
constexpr std::size_t kSealChars = 16;

/// The content behind its checksum of 16 hexadecimal digits.
std::string sealed(std::string_view content) { return hex_of(fingerprint_of(content)).append(content); }

/// The content that sealed() was given; nullopt where its checksum does not match.
std::optional<std::string> unsealed(const std::string& bytes) {
  if (bytes.size() < kSealChars) return std::nullopt;
  std::string content = bytes.substr(kSealChars);
  return sealed(content) == bytes ? std::optional{std::move(content)} : std::nullopt;
}

}  // namespace

std::vector<std::string> notes_in_parts(std::string_view head, std::string_view content) {
  const std::string text = base64_of(sealed(content));
  const std::size_t parts = (text.size() + kPartChars - 1) / kPartChars;
  std::vector<std::string> notes;
  for (std::size_t part = 0; part < parts; ++part) {
    notes.push_back(std::string(head) + " " + std::to_string(part + 1) + "/" + std::to_string(parts) + " " +
                    text.substr(part * kPartChars, kPartChars));
  }
  return notes;
}

bool PartsReader::read(std::string_view note) {
  unsigned part = 0;
  unsigned parts = 0;
  int end = 0;
  if (note.substr(0, head_.size()) != head_) return false;
  const std::string numbers{note.substr(head_.size(), 40)};
  if (std::sscanf(numbers.c_str(), " %u/%u %n", &part, &parts, &end) != 2 || end == 0 || parts == 0) return false;
  if (part == 1) *this = PartsReader{head_};
  parts_ = parts;
  if (part != read_ + 1) return true;  // a part is missing: this content never becomes complete
  ++read_;
  text_ += note.substr(head_.size() + static_cast<std::size_t>(end));
  if (read_ != parts_) return true;
  if (const auto bytes = bytes_of_base64(text_)) content_ = unsealed(*bytes);
  text_ = {};
  return true;
}

}  // namespace deltamap::daemon
