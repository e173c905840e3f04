// SPDX-License-Identifier: Apache-2.0
#include "daemon/records/site_note.hpp"

#include <nlohmann/json.hpp>

namespace deltamap::daemon {
namespace {

using SiteNoteJson = nlohmann::ordered_json;

constexpr std::string_view kSiteHead = "site";

}  // namespace

std::vector<std::string> notes_of(const SetSite& set) {
  const SiteNoteJson head{{"scan", set.scan}, {"time_ns", unix_ns(set.scan_time)}};
  return notes_in_parts(kSiteHead, head.dump() + "\n" + text_of(*set.site));
}

SetSiteReader::SetSiteReader() : parts_{kSiteHead} {}

std::optional<SetSite> SetSiteReader::read(std::string_view note) {
  if (!parts_.read(note)) return std::nullopt;
  const std::optional<std::string> content = parts_.content();
  if (!content) return std::nullopt;
  parts_ = PartsReader{kSiteHead};
  const auto end = content->find('\n');
  if (end == std::string::npos) return std::nullopt;
  try {
    const auto head = SiteNoteJson::parse(content->substr(0, end));
    SetSite set{head.at("scan").get<std::uint32_t>(), timestamp_from_ns(head.at("time_ns").get<std::int64_t>()),
                site_of_text(content->substr(end + 1))};
    return set.site ? std::optional{std::move(set)} : std::nullopt;
  } catch (const SiteNoteJson::exception&) {
    return std::nullopt;
  }
}

}  // namespace deltamap::daemon
