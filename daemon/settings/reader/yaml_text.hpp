// SPDX-License-Identifier: Apache-2.0
// Looks at the text of a settings file before it is read as YAML. Finds what a YAML reader accepts in silence (a quote
// that is not closed swallows the lines below it; a second document is not read; a typographic quote is a letter) and
// what it calls by a misleading name (a tab, a non-breaking space, a binary file).
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace deltamap::daemon {

struct TextProblem {
  int line = 1;    ///< from 1
  int column = 1;  ///< in bytes, from 1
  std::string what;
};

/// The first byte that no text has, or line ends that no reader of lines recognizes.
[[nodiscard]] std::optional<TextProblem> binary_byte(std::string_view text);

/// A line as it may be handed to a YAML reader.
struct YamlLine {
  std::string text;            ///< empty where it has a problem, or belongs to what has one
  int indentation = 0;         ///< blanks before its first character
  bool has_content = false;    ///< more than blanks and a comment
  bool begins_inside = false;  ///< of [ or { of a line above
};

struct YamlText {
  std::vector<TextProblem> problems;  ///< in the order of the text; empty where all of it may be read as YAML
  std::vector<YamlLine> lines;        ///< one for each line of the text; none where it is no text at all
};

/// Stricter than YAML: a value ends on its line.
[[nodiscard]] YamlText yaml_text(std::string_view yaml);

/// Lines from `first` up to `last`, counted from 0.
struct LineRange {
  std::size_t first = 0;
  std::size_t last = 0;
};
/// Each key of the outermost level with all that stands below it, as far as the indentation tells; the first part may
/// be indented farther, which no YAML is.
[[nodiscard]] std::vector<LineRange> parts_of(const std::vector<YamlLine>& lines, std::size_t first, std::size_t last);

/// These lines again as one text.
[[nodiscard]] std::string text_of(const std::vector<YamlLine>& lines, std::size_t first, std::size_t last);

}  // namespace deltamap::daemon
