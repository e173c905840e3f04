// SPDX-License-Identifier: Apache-2.0
#include "simulation/changes/change.hpp"

namespace deltamap::simulation {

std::string_view name_of(ChangeKind kind) {
  switch (kind) {
    case ChangeKind::kRemoved:
      return "removed";
    case ChangeKind::kAdded:
      return "added";
    case ChangeKind::kShifted:
      return "shifted";
    case ChangeKind::kCrept:
      break;
  }
  return "crept";
}

std::optional<ChangeKind> change_kind_named(std::string_view name) {
  for (const ChangeKind kind : {ChangeKind::kRemoved, ChangeKind::kAdded, ChangeKind::kShifted, ChangeKind::kCrept}) {
    if (name == name_of(kind)) return kind;
  }
  return std::nullopt;
}

World changed(const World& world, const Change& change) {
  if (change.kind == ChangeKind::kRemoved) return world.without(change.id);
  const Object* former = world.find(change.id);
  Object container = former != nullptr ? *former : Object{change.id, ObjectKind::kContainer, change.box};
  container.shape = change.box;
  return world.with(container);
}

}  // namespace deltamap::simulation
