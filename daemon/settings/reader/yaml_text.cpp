// SPDX-License-Identifier: Apache-2.0
#include "daemon/settings/reader/yaml_text.hpp"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <optional>
#include <utility>

#include "core/files/text_of_file.hpp"
#include "core/files/yaml_tree.hpp"
#include "daemon/settings/reader/text_character.hpp"

namespace deltamap::daemon {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t'; }

/// `marker` stands alone in its line, or a blank follows.
bool begins_with_marker(std::string_view line, std::string_view marker) {
  return line.starts_with(marker) && (line.size() == marker.size() || is_blank(line[marker.size()]));
}

bool has_content(std::string_view line) {
  const auto first = line.find_first_not_of(" \t");
  return first != std::string_view::npos && line[first] != '#';
}

std::string hex_of(char byte) {
  char hex[8];
  (void)std::snprintf(hex, sizeof hex, "%02Xh", static_cast<unsigned>(static_cast<unsigned char>(byte)));
  return hex;
}

/// Goes through the lines one by one.
class Lines {
 public:
  void read(std::string_view line) {
    ++number_;
    if (number_ == 1 && line.starts_with(kUtf8Mark)) line.remove_prefix(kUtf8Mark.size());
    if (line.ends_with('\r')) line.remove_suffix(1);
    text_.lines.emplace_back();
    if (is_beyond_document(line)) return;
    const std::size_t start = std::min(line.find_first_not_of(" \t"), line.size());
    YamlLine& now = text_.lines.back();
    now = {std::string(line), static_cast<int>(start), has_content(line), depth_ > 0};
    if (depth_ == 0) flow_begin_ = text_.lines.size() - 1;
    if (!now.has_content) {
      now.text.clear();  // a tab may stand in an empty line
      return;
    }
    const bool is_dropped = now.begins_inside ? drops_flow_ : now.indentation > drop_below_;
    if (is_dropped && drops_text_) return clear(now);
    const std::size_t problems = text_.problems.size();
    if (const auto at = line.substr(0, start).find('\t'); at != std::string_view::npos) {
      add(at, "a tab in the indentation: YAML wants blanks");
    }
    const LineShape shape = read_tokens(line);
    if (is_dropped) return clear(now);
    judge_continuation(now, shape);
    begin_dropping(now, text_.problems.size() > problems, shape);
  }

  [[nodiscard]] YamlText text() && { return std::move(text_); }

 private:
  struct LineShape {
    bool has_key = false;    // a colon that ends a key, outside of [ and {
    bool has_value = false;  // something stands behind the key's colon
    bool is_text_of_lines = false;
  };

  void add(std::size_t at, std::string what) {
    text_.problems.push_back({number_, static_cast<int>(at) + 1, std::move(what)});
  }

  /// True in a second document of the file, whose beginning is reported once.
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
    const bool is_directive = !has_begun_ && line.starts_with('%');
    has_begun_ = has_begun_ || begins || (has_content(line) && !is_directive);
    return is_directive || (begins && !has_content(line.substr(3)));
  }

  LineShape read_tokens(std::string_view line) {
    LineShape shape;
    char before = ' ';         // the character to the left
    char last_visible = '\n';  // the nearest to the left that is no blank
    for (std::size_t at = 0; at < line.size(); ++at) {
      const char c = line[at];
      if (c == '#' && is_blank(before)) break;
      const bool begins_value = last_visible == '\n' || ((is_blank(before) || depth_ > 0) && last_visible == ':') ||
                                last_visible == '[' || last_visible == '{' || (depth_ > 0 && last_visible == ',');
      if (static_cast<unsigned char>(c) >= 0x80) {
        const auto character = character_at(line, at);
        judge_character(character, line, at, begins_value);
        if (character) at += character->bytes - 1;
        before = character && unusual_blank(character->code) ? ' ' : line[at];
      } else {
        const std::size_t last = read_token(line, at, begins_value, last_visible == ':', shape);
        if (last == line.size()) break;
        at = last;
        before = line[at];
      }
      if (is_blank(before)) continue;
      shape.has_value = shape.has_value || (shape.has_key && last_visible == ':') || shape.is_text_of_lines;
      last_visible = before;
    }
    return shape;
  }

  /// Where the token at `at` ends, that is of plain letters; the line's end where the rest of the line is lost with it.
  std::size_t read_token(std::string_view line, std::size_t at, bool begins_value, bool behind_colon,
                         LineShape& shape) {
    const char c = line[at];
    if (begins_value && (c == '"' || c == '\'')) {
      const auto end = end_of_quoted(line, at);
      if (end) return *end - 1;
      add(at, std::string("the quote ").append(1, c).append(" that is opened here is not closed on its line"));
      return line.size();
    }
    if (begins_value && (c == '|' || c == '>') && behind_colon) {
      add(at, std::string("'").append(1, c).append("' begins a text of several lines: no key takes one"));
      shape.is_text_of_lines = true;
      return line.size();
    }
    if ((begins_value || depth_ > 0) && (c == '[' || c == '{')) ++depth_;
    if (depth_ > 0 && (c == ']' || c == '}')) --depth_;
    if (depth_ == 0 && c == ':' && ends_key(line, at)) shape.has_key = true;
    return at;
  }

  /// Whether the colon at `at` is the one behind a key.
  static bool ends_key(std::string_view line, std::size_t at) {
    if (at + 1 == line.size() || is_blank(line[at + 1])) return true;
    const auto next = character_at(line, at + 1);
    return next && unusual_blank(next->code);
  }

  void judge_character(const std::optional<TextCharacter>& character, std::string_view line, std::size_t at,
                       bool begins_value) {
    if (!text_.problems.empty() && text_.problems.back().line == number_) return;  // one of a line is enough
    if (!character) {
      add(at, "the byte " + hex_of(line[at]) + " is no UTF-8: save the file as UTF-8");
    } else if (const auto blank = unusual_blank(character->code)) {
      add(at, *blank + ": YAML wants plain blanks");
    } else if (begins_value && is_typographic_quote(character->code)) {
      add(at, "a typographic quote: YAML wants \" or '");
    }
  }

  /// A line without a key, below a value that has begun: YAML would make both one text.
  void judge_continuation(const YamlLine& line, const LineShape& shape) {
    if (line.begins_inside) return;
    if (!shape.has_key && value_line_ > 0 && line.indentation > value_indentation_) {
      add(static_cast<std::size_t>(line.indentation),
          "goes on with the value of line " + std::to_string(value_line_) + ": a value ends on its line");
    }
    value_line_ = shape.has_key && shape.has_value ? number_ : 0;
    value_indentation_ = line.indentation;
  }

  static void clear(YamlLine& line) {
    line.text.clear();
    line.has_content = false;
  }

  /// Begins to keep lines from the YAML reader: one with a problem, with the rest of its flow and the lines below it.
  void begin_dropping(const YamlLine& line, bool has_problem, const LineShape& shape) {
    drop_below_ = kNothing;
    drops_flow_ = has_problem && depth_ > 0;
    drops_text_ = shape.is_text_of_lines;
    if (!has_problem) return;
    if (shape.is_text_of_lines || (shape.has_key && !shape.has_value)) drop_below_ = line.indentation;
    value_line_ = 0;
    for (std::size_t i = flow_begin_; i < text_.lines.size(); ++i) clear(text_.lines[i]);
  }

  static constexpr int kNothing = 1 << 30;

  YamlText text_;
  int number_ = 0;
  int depth_ = 0;               // of open [ and {
  std::size_t flow_begin_ = 0;  // the line, from 0, of the outermost [ or { that is open; else this one
  int value_line_ = 0;          // number of the previous line where that has a value; else 0
  int value_indentation_ = 0;
  int drop_below_ = kNothing;  // lines that are indented farther are dropped
  bool drops_flow_ = false;    // lines inside the open [ or { are dropped
  bool drops_text_ = false;    // what is dropped is a text of lines, not YAML
  bool has_begun_ = false;
  bool has_ended_ = false;
  bool is_second_ = false;
};

}  // namespace

std::optional<TextProblem> binary_byte(std::string_view yaml) {
  if (yaml.starts_with("\xFF\xFE") || yaml.starts_with("\xFE\xFF"))
    return TextProblem{1, 1, "UTF-16: save it as UTF-8"};
  int line = 1;
  std::size_t start = 0;
  for (std::size_t at = 0; at < yaml.size(); ++at) {
    const auto byte = static_cast<unsigned char>(yaml[at]);
    const int column = static_cast<int>(at - start) + 1;
    const bool is_lone_return = byte == '\r' && at + 1 < yaml.size() && yaml[at + 1] != '\n';
    if (byte == '\n') {
      ++line;
      start = at + 1;
    } else if (is_lone_return) {
      return TextProblem{line, column, "a carriage return without a line feed: save the file with Unix line ends"};
    } else if ((byte < 0x20 && byte != '\t' && byte != '\r') || byte == 0x7F) {
      return TextProblem{line, column, "no text file: it has the byte " + hex_of(yaml[at])};
    }
  }
  return std::nullopt;
}

YamlText yaml_text(std::string_view yaml) {
  if (const auto binary = binary_byte(yaml)) return {{*binary}, {}};
  Lines lines;
  while (!yaml.empty()) {
    const std::size_t end = std::min(yaml.find('\n'), yaml.size());
    lines.read(yaml.substr(0, end));
    yaml.remove_prefix(std::min(end + 1, yaml.size()));
  }
  return std::move(lines).text();
}

std::vector<LineRange> parts_of(const std::vector<YamlLine>& lines, std::size_t first, std::size_t last) {
  const auto may_begin = [&](std::size_t i) { return lines[i].has_content && !lines[i].begins_inside; };
  int outermost = std::numeric_limits<int>::max();
  for (std::size_t i = first; i < last; ++i) {
    if (may_begin(i)) outermost = std::min(outermost, lines[i].indentation);
  }
  std::vector<LineRange> parts;
  for (std::size_t i = first; i < last; ++i) {
    if (!may_begin(i) || (!parts.empty() && lines[i].indentation != outermost)) continue;
    if (!parts.empty()) parts.back().last = i;
    parts.push_back({i, last});
  }
  return parts;
}

std::string text_of(const std::vector<YamlLine>& lines, std::size_t first, std::size_t last) {
  std::string text;
  for (std::size_t i = first; i < last; ++i) text += lines[i].text + "\n";
  return text;
}

}  // namespace deltamap::daemon
