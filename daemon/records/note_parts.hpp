// SPDX-License-Identifier: Apache-2.0
// Bytes as notes of a recording: base64 with a checksum, in as many parts as a pcapng comment needs. What a run begins
// from and the cells that an operator has set are written so.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace deltamap::daemon {

/// "HEAD 1/3 BASE64", "HEAD 2/3 BASE64", …: each fits a pcapng comment. At least one.
[[nodiscard]] std::vector<std::string> notes_in_parts(std::string_view head, std::string_view content);

/// Puts such notes together again.
class PartsReader {
 public:
  /// Of the notes that begin with `head`, of at most 32 bytes without line end or "%".
  explicit PartsReader(std::string_view head) : head_{head} {}

  /// Any note, in order; those of other kinds are passed over. True where it was one of these.
  bool read(std::string_view note);
  /// Some part was there.
  [[nodiscard]] bool has_begun() const { return parts_ > 0; }
  /// Nothing where parts are missing, or they are damaged.
  [[nodiscard]] const std::optional<std::string>& content() const { return content_; }

 private:
  std::string head_;
  unsigned parts_ = 0;  // that there should be
  unsigned read_ = 0;
  std::string text_;
  std::optional<std::string> content_;
};

}  // namespace deltamap::daemon
