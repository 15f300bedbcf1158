# SPDX-License-Identifier: BSD-3-Clause
# The kernels of OwnMaterials of kernels/materials/list.hpp and of TissueLaws, in sources of its own, one for each kind of elements: sets material_sources. A material NeoHookean
# is in neo_hookean.hpp.
set(list ${PROJECT_SOURCE_DIR}/kernels/materials/list.hpp)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${list})
file(READ ${list} text)
if(NOT text MATCHES "using OwnMaterials = TypeList<([^>]*)>")
  message(FATAL_ERROR "${list}: no line 'using OwnMaterials = TypeList<...>;' found")
endif()
string(REGEX MATCHALL "[A-Za-z0-9_]+" materials "${CMAKE_MATCH_1}")
list(APPEND materials TissueLaws) # those of tissue_laws.hpp share theirs
set(material_sources)
foreach(Material IN LISTS materials)
  string(REGEX REPLACE "([a-z0-9])([A-Z])" "\\1_\\2" file ${Material})
  string(TOLOWER ${file} file)
  if(NOT EXISTS ${PROJECT_SOURCE_DIR}/kernels/materials/${file}.hpp)
    message(FATAL_ERROR "${list} names ${Material}; its file kernels/materials/${file}.hpp is not there")
  endif()
  foreach(element linear nodal)
    set(for_each PLICA_FOR_EACH_BACKEND)
    if(element STREQUAL nodal) # preconditioners take products with them in float
      set(for_each PLICA_FOR_EACH_PRECISION)
    endif()
    set(source ${PROJECT_BINARY_DIR}/materials/${element}_elasticity_of_${file}.cpp)
    configure_file(${PROJECT_SOURCE_DIR}/drivers/elastic/elasticity_of.cpp.in ${source} @ONLY)
    list(APPEND material_sources ${source})
  endforeach()
endforeach()
set_source_files_properties(${material_sources} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
