// SPDX-License-Identifier: Apache-2.0
// The subcommands of `deltamap`, one file each. A subcommand registers its options and, as CLI callback, does its job;
// it throws std::runtime_error with one line that names file and place where it cannot.
#pragma once

namespace CLI {
class App;
}

namespace deltamap::tool {

void add_bays(CLI::App& app);
void add_compare(CLI::App& app);
void add_ctl(CLI::App& app);
void add_decode(CLI::App& app);
void add_export(CLI::App& app);
void add_incident(CLI::App& app);
void add_info(CLI::App& app);
void add_score(CLI::App& app);
void add_sim(CLI::App& app);

// under `deltamap calibrate`
void add_calibrate_motion(CLI::App& calibrate);

// under `deltamap import`
void add_import_carmen(CLI::App& import);
void add_import_messages(CLI::App& import);

void add_replay(CLI::App& app);
void add_sweep(CLI::App& app);
void add_things(CLI::App& app);
void add_view(CLI::App& app);

// under `deltamap score`
void add_score_relations(CLI::App& score);

// under `deltamap map`
void add_map_build(CLI::App& map);
void add_map_compare(CLI::App& map);
void add_map_film(CLI::App& map);
void add_map_from_poses(CLI::App& map);
void add_map_history(CLI::App& map);
void add_map_merge(CLI::App& map);
void add_map_picture(CLI::App& map);
void add_map_quality(CLI::App& map);

}  // namespace deltamap::tool
