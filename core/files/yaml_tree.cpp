// SPDX-License-Identifier: Apache-2.0
#include "core/files/yaml_tree.hpp"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <sstream>
#include <string_view>
#include <utility>

namespace deltamap {
namespace {

constexpr int kBeforeTheFirst = -1;  // document
constexpr std::string_view kBelongsToNothing = "belongs to nothing";  // our own, beside the YAML reader's

/// The YAML reader's words, and what they mean to whoever wrote the file.
constexpr std::array<std::pair<std::string_view, std::string_view>, 9> kMeanings{{
    {kBelongsToNothing, "this belongs to no key: look at the indentation of this line and of those above"},
    {"illegal map value", "a ':' is out of place: look at the indentation, or put the value into quotes"},
    {"end of map not found", "the indentation does not fit the lines above"},
    {"end of sequence not found", "the indentation does not fit the lines above"},
    {"end of map flow not found", "a '{' is not closed"},
    {"end of sequence flow not found", "a '[' is not closed"},
    {"unknown escape character", "a backslash in double quotes: write it twice, or use single quotes"},
    {"bad file", "brackets are nested too deeply"},
    {"unknown token", "a character that begins no value: put the value into quotes"},
}};

/// Notes where a document begins and whether there is anything in it.
class BeginOfDocument : public YAML::EventHandler {
 public:
  void OnDocumentStart(const YAML::Mark& mark) override {
    mark_ = mark;
    is_empty_ = true;
  }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& /*mark*/, YAML::anchor_t /*anchor*/) override {}
  void OnAlias(const YAML::Mark& /*mark*/, YAML::anchor_t /*anchor*/) override { is_empty_ = false; }
  void OnScalar(const YAML::Mark& /*mark*/, const std::string& /*tag*/, YAML::anchor_t /*anchor*/,
                const std::string& /*value*/) override {
    is_empty_ = false;
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
  YAML::Mark mark_;
  bool is_empty_ = true;
};

}  // namespace

YAML::Node only_yaml_tree(const std::string& text) {
  std::istringstream bytes(text);
  YAML::Parser parser(bytes);  // not YAML::LoadAll: where a sign is out of place it never ends
  BeginOfDocument begin;
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
