# SPDX-License-Identifier: Apache-2.0
# Writes TARGET, a source that holds the FILES (paths from FOLDER on) byte for byte, by their last names: page_files() of
# NAMESPACE, which HEADER declares.
set(types_html "text/html; charset=utf-8")
set(types_css "text/css; charset=utf-8")
set(types_js "text/javascript; charset=utf-8")
set(types_md "text/markdown; charset=utf-8")
set(arrays "")
set(table "")
set(number 0)
foreach(path IN LISTS FILES)
  file(READ ${FOLDER}/${path} hex HEX)
  get_filename_component(name ${path} NAME)
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "'\\\\x\\1'," bytes "${hex}")
  string(REGEX REPLACE "^.*\\." "" extension ${name})
  string(APPEND arrays "const char kFile${number}[] = {${bytes}};\n")
  string(APPEND table "    {\"${name}\", \"${types_${extension}}\", {kFile${number}, sizeof kFile${number}}},\n")
  math(EXPR number "${number} + 1")
endforeach()
file(WRITE ${TARGET} "// SPDX-License-Identifier: Apache-2.0
#include \"${HEADER}\"

using deltamap::daemon::dashboard::PageFile;

namespace ${NAMESPACE} {
namespace {

${arrays}
const PageFile kFiles[] = {
${table}};

}  // namespace

std::span<const PageFile> page_files() { return kFiles; }

}  // namespace ${NAMESPACE}
")
