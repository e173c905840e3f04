// SPDX-License-Identifier: Apache-2.0
#include "daemon/telemetry/version.hpp"

namespace deltamap::daemon {
namespace {

#ifdef __clang__
constexpr const char* kCompiler = "clang " __clang_version__;
#else
constexpr const char* kCompiler = "GCC " __VERSION__;
#endif

}  // namespace

std::string_view version() { return DELTAMAP_VERSION; }

std::string version_text() {
  return std::string(version()) + " (commit " + std::string(commit()) + ", " + kCompiler + ", " +
         std::to_string(8 * sizeof(void*)) + " bit)";
}

}  // namespace deltamap::daemon
