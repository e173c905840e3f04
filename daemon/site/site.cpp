// SPDX-License-Identifier: Apache-2.0
#include "daemon/site/site.hpp"

#include <stdexcept>

#include "daemon/site/bays_file.hpp"
#include "daemon/site/zones_file.hpp"

namespace deltamap::daemon {
namespace {

constexpr char kBetween = '\0';  // the two texts

}  // namespace

SharedSite site_on(const GridGeometry& map, const std::string& bays_file, const std::string& zones_file) {
  return std::make_shared<const Site>(Site{bays_on(map, bays_file), zones_on(map, zones_file)});
}

std::string text_of(const Site& site) { return bays_as_yaml(site.bays) + kBetween + zones_as_yaml(site.zones); }

SharedSite site_of_text(const std::string& text) {
  const std::size_t between = text.find(kBetween);
  if (between == std::string::npos) return nullptr;
  try {
    return std::make_shared<const Site>(
        Site{bays_of_text(text.substr(0, between), "recording"), zones_of_text(text.substr(between + 1), "recording")});
  } catch (const std::runtime_error&) {
    return nullptr;
  }
}

}  // namespace deltamap::daemon
