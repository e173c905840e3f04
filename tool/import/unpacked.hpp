// SPDX-License-Identifier: Apache-2.0
// Chunks of bags and MCAP files as they were before they were compressed.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace deltamap::tool {

/// `method`: "" or "none", "bz2", "lz4" (its frame format), "zstd". `size`: what comes out of it, as its head tells; a
/// chunk of more than 1 GB is refused. Throws std::runtime_error: why it cannot be read.
[[nodiscard]] std::string unpacked(std::string_view method, std::string_view bytes, std::uint64_t size);

}  // namespace deltamap::tool
