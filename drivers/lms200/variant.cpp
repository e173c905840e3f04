// SPDX-License-Identifier: Apache-2.0
#include "drivers/lms200/variant.hpp"

#include <algorithm>
#include <array>

namespace deltamap::drivers::lms200 {
namespace {

struct NamedVariant {
  const char* name;
  ScanVariant variant;
};

constexpr auto kVariants = std::to_array<NamedVariant>({
    {"180/1", {180, 100}},
    {"180/0.5", {180, 50}},
    {"100/1", {100, 100}},
    {"100/0.5", {100, 50}},
    {"100/0.25", {100, 25}},
    {"90/0.5", {90, 50}},
});

template <typename Predicate>
const NamedVariant* find_variant(Predicate&& is_wanted) {
  const auto* const found = std::find_if(kVariants.begin(), kVariants.end(), is_wanted);
  return found != kVariants.end() ? found : nullptr;
}

}  // namespace

bool is_possible(const ScanVariant& variant) {
  return find_variant([&](const NamedVariant& v) { return v.variant == variant; }) != nullptr;
}

std::optional<ScanVariant> variant_named(std::string_view name) {
  const NamedVariant* found = find_variant([&](const NamedVariant& v) { return v.name == name; });
  return found != nullptr ? std::optional{found->variant} : std::nullopt;
}

std::string name_of(const ScanVariant& variant) {
  const NamedVariant* found = find_variant([&](const NamedVariant& v) { return v.variant == variant; });
  if (found != nullptr) return found->name;
  return std::to_string(variant.angle_deg) + "/" + std::to_string(variant.resolution_centideg) + "e-2";
}

std::optional<ScanVariant> variant_with_values(unsigned values) {
  const NamedVariant* found = find_variant([&](const NamedVariant& v) { return v.variant.values() == values; });
  return found != nullptr ? std::optional{found->variant} : std::nullopt;
}

}  // namespace deltamap::drivers::lms200
