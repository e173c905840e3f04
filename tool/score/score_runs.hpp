// SPDX-License-Identifier: Apache-2.0
// `deltamap score REC-or-DIR …`: what runs are worth, by whatever is known of the true way, and without any.
#pragma once

#include "tool/tune/tuning_options.hpp"

namespace deltamap::tool::tune {

/// Scores recordings, replayed now with some seeds, or folders of runs (--out of daemon and replay). Prints a table or
/// JSON. Throws std::runtime_error, SettingsError.
void score_runs(TuningOptions options);

}  // namespace deltamap::tool::tune
