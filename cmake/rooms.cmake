# SPDX-License-Identifier: BSD-3-Clause
# The rooms of drivers/ that the library plica is made of: each may include those before it.
set(plica_rooms methods body elastic loads contact spaces level linear time cycles run)
list(TRANSFORM plica_rooms PREPEND drivers/)
list(TRANSFORM plica_rooms REPLACE "(.+)" "${CMAKE_CURRENT_LIST_DIR}/../\\1/*.cpp" OUTPUT_VARIABLE room_sources)
file(GLOB_RECURSE room_sources CONFIGURE_DEPENDS ${room_sources})
