# SPDX-License-Identifier: Apache-2.0
# Writes which commit the source is at into a small C++ file: cmake -DSOURCE=DIR -DTARGET=FILE -P commit.cmake.
# Runs at every build; the file is touched only where the commit has changed, so that nothing else is built again.
# In a folder that is no repository of its own the file COMMIT names it, where there is one (`./dev deb` writes it);
# otherwise the commit is "unknown".
set(commit unknown)
if(EXISTS ${SOURCE}/COMMIT)
  file(STRINGS ${SOURCE}/COMMIT commit LIMIT_COUNT 1)
endif()
find_program(GIT git)
if(GIT)
  # Whoever builds may be another user than the owner of the files: root, in a container.
  set(git ${GIT} -c safe.directory=* -C ${SOURCE})
  execute_process(COMMAND ${git} rev-parse --show-toplevel OUTPUT_VARIABLE top OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  file(REAL_PATH ${SOURCE} source)
  if(top STREQUAL source)
    execute_process(COMMAND ${git} rev-parse --short HEAD
      OUTPUT_VARIABLE head OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
    # Results that are written on the way do not count as changes.
    execute_process(COMMAND ${git} --no-optional-locks status --porcelain --untracked-files=no -- . ":!docs/results"
      OUTPUT_VARIABLE changes ERROR_QUIET)
    if(NOT failed)
      set(commit ${head})
    endif()
    if(NOT failed AND changes)
      string(APPEND commit -dirty)
    endif()
  endif()
endif()
file(CONFIGURE OUTPUT ${TARGET} @ONLY CONTENT [[
#include "daemon/telemetry/version.hpp"

namespace deltamap::daemon {

std::string_view commit() { return "@commit@"; }

}  // namespace deltamap::daemon
]])
