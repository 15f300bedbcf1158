# SPDX-License-Identifier: BSD-3-Clause
# Writes the version source file, at every build: the commit may be another one. An unchanged file keeps its time stamp, so
# nothing follows from it. cmake -D source= -D output= -D version= -D compiler= -P revision.cmake
find_package(Git QUIET)
if(Git_FOUND AND EXISTS ${source}/.git)
  execute_process(COMMAND ${GIT_EXECUTABLE} describe --always --dirty --tags WORKING_DIRECTORY ${source}
    OUTPUT_VARIABLE revision OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
endif()
if(NOT revision)
  set(revision "$Format:%h$") # git writes the commit here when it packs an archive
endif()
if(revision MATCHES Format)
  set(revision unknown)
endif()
configure_file(${CMAKE_CURRENT_LIST_DIR}/version.cpp.in ${output} @ONLY)
