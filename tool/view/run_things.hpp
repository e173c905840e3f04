// SPDX-License-Identifier: Apache-2.0
// The things of a run as its page shows them: what things.jsonl of the run's folder tells up to a moment.
#pragma once

#include <filesystem>
#include <string>

#include "core/time.hpp"

namespace deltamap::tool {

/// {"ok":true,"things":[…],"unread":N}: of each thing the newest line up to `time`, in the order of their ids. N lines
/// are no lines of things.jsonl; one that is still being written does not count. Without a file there is no thing.
[[nodiscard]] std::string things_at(const std::filesystem::path& things_jsonl, Timestamp time);

}  // namespace deltamap::tool
