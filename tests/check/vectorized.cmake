# SPDX-License-Identifier: Apache-2.0
# Fails where the loops that weigh beams (localization/sensor/weighing.cpp) use no 256-bit register: a compiler that gives
# vectorization up says nothing. cmake -DOBJDUMP=PROGRAM -DLIBRARY=FILE -P vectorized.cmake
execute_process(COMMAND ${OBJDUMP} -d --no-show-raw-insn ${LIBRARY} OUTPUT_VARIABLE code COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "%ymm[0-9]+" used "${code}")
list(LENGTH used uses)
if(uses LESS 20)
  message(FATAL_ERROR "${LIBRARY}: ${uses} uses of 256-bit registers: the loops of weighing.cpp are not vectorized")
endif()
