// SPDX-License-Identifier: Apache-2.0
#include "core/files/yaml_tree.hpp"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <sstream>
#include <string_view>
#include <utility>

#include "core/files/text_of_file.hpp"

namespace deltamap {
namespace {

constexpr int kBeforeTheFirst = -1;                                   // document
constexpr std::string_view kBelongsToNothing = "belongs to nothing";  // our own two, beside the YAML reader's
constexpr std::string_view kOpenQuote = "quote not closed";

constexpr std::string_view kBackslash = "a backslash in double quotes: write it twice, or use single quotes";
constexpr std::string_view kSignOfAnchors = "a '*', '&' or '!' begins a value: put the value into quotes";
constexpr std::string_view kTextOfLines = "a '|' or '>' begins a text of lines: put the value into quotes";
constexpr std::string_view kDirective = "a '%' begins a line: take the line away, or put the value into quotes";

/// The YAML reader's words, and what they mean to whoever wrote the file.
constexpr std::array<std::pair<std::string_view, std::string_view>, 32> kMeanings{{
    {kBelongsToNothing, "this belongs to no key: look at the indentation of this line and of those above"},
    {kOpenQuote, "a quote is not closed on its line"},
    {"illegal map value", "a ':' is out of place: look at the indentation, or put the value into quotes"},
    {"end of map not found", "the indentation does not fit the lines above"},
    {"end of sequence not found", "the indentation does not fit the lines above"},
    {"end of map flow not found", "a '{' is not closed"},
    {"end of sequence flow not found", "a '[' is not closed"},
    {"unknown escape character", kBackslash},
    {"bad file", "brackets are nested too deeply"},
    {"unknown token", "a character that begins no value: put the value into quotes"},
    {"illegal flow end", "a ']' or '}' closes no bracket that is open: look at the brackets, or use quotes"},
    {"illegal block entry", "a '-' is out of place: begin a line of its own with it, or put the value into quotes"},
    {"illegal map key", "a '?' or a key is out of place: look at the indentation, or put the value into quotes"},
    {"illegal tab", "a tab in the indentation: YAML wants blanks"},
    {"illegal EOF in scalar", "a quote is not closed"},
    {"illegal document indicator in scalar", "a quote that is opened above is not closed"},
    {"the referenced anchor is not defined", "a '*' begins a value, and names no anchor: put the value into quotes"},
    {"alias not found", kSignOfAnchors},
    {"anchor not found", kSignOfAnchors},
    {"illegal character found while scanning", kSignOfAnchors},
    {"end of verbatim tag not found", kSignOfAnchors},
    {"tag handle with no suffix", kSignOfAnchors},
    {"cannot assign", kSignOfAnchors},
    {"aliases can't have", kSignOfAnchors},
    {"bad character found while scanning hex", kBackslash},
    {"invalid unicode", kBackslash},
    {"unexpected character in block scalar", kTextOfLines},
    {"cannot set zero indentation", kTextOfLines},
    {"YAML ", kDirective},
    {"bad YAML version", kDirective},
    {"repeated ", kDirective},
    {"TAG ", kDirective},
}};

/// Notes where a document begins and whether there is anything in it. Refuses quotes that are open at the end of their
/// line.
class EventsOfDocument : public YAML::EventHandler {
 public:
  explicit EventsOfDocument(std::string_view text) : text_{text} {
    if (text_.starts_with(kUtf8Mark)) text_.remove_prefix(kUtf8Mark.size());  // the parser's places do not count it
  }

  void OnDocumentStart(const YAML::Mark& mark) override {
    mark_ = mark;
    is_empty_ = true;
  }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& /*mark*/, YAML::anchor_t /*anchor*/) override {}
  void OnAlias(const YAML::Mark& /*mark*/, YAML::anchor_t /*anchor*/) override { is_empty_ = false; }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t /*anchor*/,
                const std::string& /*value*/) override {
    is_empty_ = false;
    if (tag == kNotPlain) require_closed_quote(mark);
  }
  void OnSequenceStart(const YAML::Mark& /*mark*/, const std::string& /*tag*/, YAML::anchor_t /*anchor*/,
                       YAML::EmitterStyle::value /*style*/) override {
    is_empty_ = false;
  }
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark& /*mark*/, const std::string& /*tag*/, YAML::anchor_t /*anchor*/,
                  YAML::EmitterStyle::value /*style*/) override {
    is_empty_ = false;
  }
  void OnMapEnd() override {}

  [[nodiscard]] YAML::Mark mark() const { return mark_; }
  [[nodiscard]] bool is_empty() const { return is_empty_; }

 private:
  static constexpr std::string_view kNotPlain = "!";  // the tag of what stands in quotes, or behind | or >

  /// The parser ends a quote that is open at the end of the text there, and says nothing of what it swallowed.
  void require_closed_quote(const YAML::Mark& mark) const {
    const std::size_t at =
        text_.find_first_of("\"'|>\n", static_cast<std::size_t>(mark.pos));  // an anchor may stand before
    if (at == std::string_view::npos || (text_[at] != '"' && text_[at] != '\'')) return;
    if (!end_of_quoted(text_.substr(0, text_.find('\n', at)), at)) throw YAML::ParserException(mark, kOpenQuote.data());
  }

  std::string_view text_;
  YAML::Mark mark_;
  bool is_empty_ = true;
};

}  // namespace

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

YAML::Node only_yaml_tree(const std::string& text) {
  std::istringstream bytes(text);
  YAML::Parser parser(bytes);  // not YAML::LoadAll: where a sign is out of place it never ends
  EventsOfDocument begin(text);
  int before = kBeforeTheFirst;
  for (; parser.HandleNextDocument(begin); before = begin.mark().pos) {
    const bool stands_still = begin.mark().pos == before;  // at a sign that no value has: the parser steps over none
    const bool is_another = before != kBeforeTheFirst && !begin.is_empty();
    if (stands_still || is_another) throw YAML::ParserException(begin.mark(), kBelongsToNothing.data());
  }
  return YAML::Load(text);
}

std::string meaning_of(const YAML::Exception& error) {
  const auto* known = std::find_if(kMeanings.begin(), kMeanings.end(),
                                   [&](const auto& one) { return error.msg.starts_with(one.first); });
  return "not YAML: " + (known == kMeanings.end() ? error.msg : std::string(known->second));
}

std::string placed_meaning_of(const YAML::Exception& error, const std::string& text) {
  const auto breaks = std::count(text.begin(), text.end(), '\n');
  const auto last = breaks - (text.ends_with('\n') ? 1 : 0);
  const auto line = std::min<std::ptrdiff_t>(std::max(error.mark.line, 0), std::max<std::ptrdiff_t>(last, 0)) + 1;
  return "line " + std::to_string(line) + ": " + meaning_of(error);
}

}  // namespace deltamap
