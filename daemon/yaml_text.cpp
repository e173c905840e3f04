// SPDX-License-Identifier: Apache-2.0
#include "daemon/yaml_text.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <optional>

namespace deltamap::daemon {
namespace {

constexpr std::string_view kUtf8Mark = "\xEF\xBB\xBF";

bool is_blank(char c) { return c == ' ' || c == '\t'; }

/// `marker` stands alone in its line, or a blank follows.
bool begins_with_marker(std::string_view line, std::string_view marker) {
  return line.starts_with(marker) && (line.size() == marker.size() || is_blank(line[marker.size()]));
}

bool has_content(std::string_view line) {
  const auto first = line.find_first_not_of(" \t");
  return first != std::string_view::npos && line[first] != '#';
}

/// Behind the closing quote, or nothing where the line has none.
std::optional<std::size_t> end_of_quoted(std::string_view line, std::size_t opening) {
  const char quote = line[opening];
  for (std::size_t at = opening + 1; at < line.size(); ++at) {
    if (quote == '"' && line[at] == '\\') {
      ++at;
    } else if (line[at] == quote) {
      if (quote == '"' || at + 1 == line.size() || line[at + 1] != '\'') return at + 1;
      ++at;  // '' is a quote within the text
    }
  }
  return std::nullopt;
}

/// Goes through the lines one by one.
class Lines {
 public:
  void read(std::string_view line) {
    ++number_;
    if (number_ == 1 && line.starts_with(kUtf8Mark)) line.remove_prefix(kUtf8Mark.size());
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (is_beyond_document(line)) return;
    const std::size_t tab = std::min(line.find_first_not_of(" \t"), line.size());
    if (const auto at = line.substr(0, tab).find('\t'); at != std::string_view::npos && has_content(line)) {
      add(at, "a tab in the indentation: YAML wants blanks");
    }
    read_tokens(line);
  }

  [[nodiscard]] std::vector<TextProblem> problems() && { return std::move(problems_); }

 private:
  void add(std::size_t at, std::string what) {
    problems_.push_back({number_, static_cast<int>(at) + 1, std::move(what)});
  }

  /// A second document is told once, where it begins.
  bool is_beyond_document(std::string_view line) {
    const bool begins = begins_with_marker(line, "---");
    if (begins_with_marker(line, "...")) {
      has_ended_ = true;
      return true;
    }
    if (is_second_) return true;
    if ((begins && has_begun_) || (has_ended_ && has_content(line))) {
      is_second_ = true;
      add(0, "a second YAML document begins here: the settings are one");
      return true;
    }
    has_begun_ = has_begun_ || begins || (has_content(line) && !line.starts_with('%'));
    return begins && line.size() == 3;
  }

  void read_tokens(std::string_view line) {
    char before = ' ';         // the character to the left
    char last_visible = '\n';  // the nearest to the left that is no blank
    for (std::size_t at = 0; at < line.size(); ++at) {
      const char c = line[at];
      if (c == '#' && is_blank(before)) return;
      const bool begins_value = last_visible == '\n' || ((is_blank(before) || depth_ > 0) && last_visible == ':') ||
                                last_visible == '[' || last_visible == '{' || (depth_ > 0 && last_visible == ',');
      if (begins_value && (c == '"' || c == '\'')) {
        const auto end = end_of_quoted(line, at);
        if (!end) return add(at, std::string("the quote ") + c + " that is opened here is not closed on its line");
        at = *end - 1;
      } else if (begins_value && (c == '|' || c == '>') && last_visible == ':') {
        return add(at, std::string("'") + c + "' begins a text of several lines: no key takes one");
      } else if ((begins_value || depth_ > 0) && (c == '[' || c == '{')) {
        ++depth_;
      } else if (depth_ > 0 && (c == ']' || c == '}')) {
        --depth_;
      }
      before = line[at];
      if (!is_blank(before)) last_visible = before;
    }
  }

  std::vector<TextProblem> problems_;
  int number_ = 0;
  int depth_ = 0;  // of [ and {
  bool has_begun_ = false;
  bool has_ended_ = false;
  bool is_second_ = false;
};

/// A byte that no text has.
std::optional<TextProblem> binary_byte(std::string_view yaml) {
  if (yaml.starts_with("\xFF\xFE") || yaml.starts_with("\xFE\xFF"))
    return TextProblem{1, 1, "UTF-16: save it as UTF-8"};
  int line = 1;
  std::size_t start = 0;
  for (std::size_t at = 0; at < yaml.size(); ++at) {
    const auto byte = static_cast<unsigned char>(yaml[at]);
    if (byte == '\n') {
      ++line;
      start = at + 1;
    } else if ((byte < 0x20 && byte != '\t' && byte != '\r') || byte == 0x7F) {
      char hex[8];
      (void)std::snprintf(hex, sizeof hex, "%02Xh", byte);
      return TextProblem{line, static_cast<int>(at - start) + 1, std::string("no text file: it has the byte ") + hex};
    }
  }
  return std::nullopt;
}

}  // namespace

std::vector<TextProblem> problems_of_text(std::string_view yaml) {
  if (const auto binary = binary_byte(yaml)) return {*binary};
  Lines lines;
  while (!yaml.empty()) {
    const std::size_t end = std::min(yaml.find('\n'), yaml.size());
    lines.read(yaml.substr(0, end));
    yaml.remove_prefix(std::min(end + 1, yaml.size()));
  }
  return std::move(lines).problems();
}

}  // namespace deltamap::daemon
