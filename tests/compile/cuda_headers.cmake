# SPDX-License-Identifier: BSD-3-Clause
# The few headers in which a Kokkos built without CUDA differs from one built with it, in cuda_headers; all others are found
# in kokkos_headers. Kokkos keeps its configuration in these files alone and includes them as <...>.
get_target_property(directories Kokkos::kokkoscore INTERFACE_INCLUDE_DIRECTORIES)
find_path(kokkos_headers KokkosCore_config.h PATHS ${directories} NO_CACHE NO_DEFAULT_PATH REQUIRED)
set(cuda_headers ${CMAKE_CURRENT_BINARY_DIR}/cuda-headers)

foreach(header KokkosCore_config.h desul/atomics/Config.hpp)
  file(READ ${kokkos_headers}/${header} text)
  string(REGEX REPLACE "/\\* #undef ((KOKKOS|DESUL_ATOMICS)_ENABLE_CUDA|KOKKOS_ENABLE_SERIAL|KOKKOS_ARCH_HOPPER(90)?) \\*/"
    "#define \\1" text "${text}")
  file(CONFIGURE OUTPUT ${cuda_headers}/${header} CONTENT "${text}" @ONLY)
endforeach()
file(CONFIGURE OUTPUT ${cuda_headers}/KokkosCore_Config_SetupBackend.hpp CONTENT "#include <setup/Kokkos_Setup_Cuda.hpp>\n")
foreach(kind Fwd Declare)
  string(TOLOWER ${kind} folder)
  string(REPLACE declare decl folder ${folder})
  set(text "#pragma once\n")
  foreach(backend OPENMP SERIAL CUDA)
    string(APPEND text "#include <${folder}/Kokkos_${kind}_${backend}.hpp>\n")
  endforeach()
  file(CONFIGURE OUTPUT ${cuda_headers}/KokkosCore_Config_${kind}Backend.hpp CONTENT "${text}")
endforeach()
