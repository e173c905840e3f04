// SPDX-License-Identifier: Apache-2.0
// What is wrong with a map store: whether the file itself is no good, or it just cannot be written now.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

namespace deltamap::mapping::store {

/// One line that names the file.
struct StoreError : std::runtime_error {
  enum class Kind : std::uint8_t {
    kUnsound,   ///< damaged, or no map store
    kReadOnly,  ///< may be read and not written
    kOther      ///< a full disk, another program, a revision that there is not
  };
  StoreError(const std::string& line, Kind what) : std::runtime_error{line}, kind{what} {}
  Kind kind;
};

}  // namespace deltamap::mapping::store
