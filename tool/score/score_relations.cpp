// SPDX-License-Identifier: Apache-2.0
// `deltamap score relations`: how well a trajectory agrees with measured relations between its poses, for comparing
// maps of recorded logs.
#include <CLI/CLI.hpp>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "core/counted.hpp"
#include "core/geometry/angle.hpp"
#include "simulation/score/relation_score.hpp"
#include "tool/subcommands.hpp"

namespace deltamap::tool {
namespace {

namespace score = simulation::score;
using Json = nlohmann::ordered_json;

struct RelationOptions {
  std::filesystem::path trajectory;
  std::filesystem::path relations;
  bool json = false;
};

Json json_of(const score::MeanAndDeviation& figure, double unit = 1.0) {
  return {{"mean", figure.mean / unit}, {"deviation", figure.deviation / unit}};
}

void print_relation_score(const score::RelationScore& found, bool json) {
  const double degree = radians(1.0);
  if (json) {
    std::cout << Json{{"relations", found.relations},
                      {"outside", found.outside},
                      {"translation_m", json_of(found.translation_m)},
                      {"translation2_m2", json_of(found.translation2_m2)},
                      {"rotation_deg", json_of(found.rotation_rad, degree)},
                      {"rotation2_deg2", json_of(found.rotation2_rad2, degree * degree)}}
                     .dump(2)
              << '\n';
    return;
  }
  const auto print = [](const char* what, const score::MeanAndDeviation& figure, double unit, const char* name) {
    std::cout << what << figure.mean / unit << " +- " << figure.deviation / unit << ' ' << name << '\n';
  };
  std::cout << counted(found.relations, "relation") << ", " << found.outside << " outside of the trajectory\n"
            << std::fixed;
  std::cout << std::setprecision(4);
  print("translation:         ", found.translation_m, 1.0, "m");
  print("translation squared: ", found.translation2_m2, 1.0, "m²");
  print("rotation:            ", found.rotation_rad, degree, "deg");
  print("rotation squared:    ", found.rotation2_rad2, degree * degree, "deg²");
}

void run_score_relations(const RelationOptions& options) {
  const auto relations = score::read_relations(options.relations);
  const auto found = score::relation_score(score::read_trajectory(options.trajectory), relations);
  if (found.relations == 0) {
    throw std::runtime_error(options.relations.string() + ": no relation lies within the time of " +
                             options.trajectory.string());
  }
  print_relation_score(found, options.json);
}

}  // namespace

void add_score_relations(CLI::App& score) {
  auto options = std::make_shared<RelationOptions>();
  CLI::App& command =
      *score.add_subcommand("relations", "a trajectory against measured relations (Kümmerle et al. 2009)");
  command.add_option("TRAJECTORY", options->trajectory, "TUM file, in any frame")->required();
  command.add_option("RELATIONS", options->relations, "lines t1 t2 x y z roll pitch yaw")->required();
  command.add_flag("--json", options->json, "print JSON");
  command.callback([options] { run_score_relations(*options); });
}

}  // namespace deltamap::tool
