# SPDX-License-Identifier: BSD-3-Clause
# How our own code is compiled. All of it is private to this build, but for the vector width: that is part of the types in
# the headers, so whoever links the library is told.
include(CheckCXXCompilerFlag)
include(CheckCXXSourceCompiles)

add_library(plica_rules INTERFACE)   # for any processor
add_library(plica_options INTERFACE) # the same, for this one
target_link_libraries(plica_options INTERFACE plica_rules)

# Sums keep their order and NaN stays NaN (no -ffast-math); nobody reads errno or traps.
target_compile_options(plica_rules INTERFACE -fno-math-errno -fno-trapping-math)

# nvcc hands the host compiler generated code, on which warnings say nothing about ours.
if(NOT Kokkos_ENABLE_CUDA)
  target_compile_options(plica_rules INTERFACE -Wall -Wextra -Wshadow -Wconversion)
  if(CMAKE_CXX_COMPILER_ID STREQUAL GNU AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    # false positives on "text" + std::string
    target_compile_options(plica_rules INTERFACE -Wno-restrict -Wno-stringop-overflow -Wno-stringop-overread -Wno-array-bounds)
  endif()
  if(PLICA_WARNINGS_AS_ERRORS)
    target_compile_options(plica_rules INTERFACE -Werror)
  endif()
endif()

# PLICA_BACKENDS: sets plica_left_out, definitions for core/backend.hpp.
set(plica_left_out)
set(asked ${PLICA_BACKENDS})
if(NOT asked STREQUAL all)
  set(known float double Serial OpenMP Cuda)
  foreach(backend IN LISTS asked)
    if(NOT backend IN_LIST known)
      message(FATAL_ERROR "PLICA_BACKENDS has '${backend}'; expected all, or a list of ${known}")
    endif()
  endforeach()
  if(NOT double IN_LIST asked)
    message(FATAL_ERROR "PLICA_BACKENDS is '${PLICA_BACKENDS}'; expected double in it, which set-up works in")
  endif()
  if(NOT float IN_LIST asked)
    list(APPEND plica_left_out PLICA_WITHOUT_FLOAT)
  endif()
  if(Kokkos_ENABLE_SERIAL AND Kokkos_ENABLE_OPENMP AND OpenMP IN_LIST asked AND NOT Serial IN_LIST asked)
    list(APPEND plica_left_out PLICA_WITHOUT_SERIAL)
  endif()
endif()

set(native)
if(PLICA_NATIVE)
  check_cxx_compiler_flag(-march=native PLICA_HAS_MARCH_NATIVE)
  if(PLICA_HAS_MARCH_NATIVE)
    set(native -march=native)
    target_compile_options(plica_options INTERFACE ${native})
    # Eigen's alignments grow with -march. Here they stay those of a program built without, so that its objects can
    # pass between this library and any other; what Eigen does for us is set-up, not worth vector instructions.
    target_compile_definitions(plica_options INTERFACE
      EIGEN_DONT_VECTORIZE EIGEN_MAX_ALIGN_BYTES=16 EIGEN_MAX_STATIC_ALIGN_BYTES=16)
  endif()
endif()

# Sources of a library that are compiled several at a time share the parsing of headers and what these instantiate. Names in their
# anonymous namespaces must differ within the library.
function(plica_unity library at_a_time)
  set(unity OFF)
  if(PLICA_UNITY AND NOT Kokkos_ENABLE_CUDA) # where a compiler works on one kernel long enough
    set(unity ON)
  endif()
  set_target_properties(${library} PROPERTIES UNITY_BUILD ${unity} UNITY_BUILD_BATCH_SIZE ${at_a_time}
    UNITY_BUILD_CODE_AFTER_INCLUDE "#undef PLICA_INSTANTIATE")
endfunction()

# For code that no step waits for: three quarters of the time to compile it. Products and sums are contracted as at -O3, so that
# results keep their bits. Not for a library whose templates the solver instantiates, too: the linker keeps one of the copies.
function(plica_optimise_less library)
  target_compile_options(${library} PRIVATE
    $<$<AND:$<CONFIG:Release>,$<CXX_COMPILER_ID:GNU>>:-O1$<SEMICOLON>-fexpensive-optimizations>)
endfunction()

# Bytes of a vector register under these flags and Kokkos's own; on a GPU a thread works on one number.
if(Kokkos_ENABLE_CUDA OR Kokkos_ENABLE_HIP OR Kokkos_ENABLE_SYCL)
  set(PLICA_VECTOR_BYTES 8)
else()
  set(CMAKE_REQUIRED_FLAGS ${native})
  set(CMAKE_REQUIRED_LIBRARIES Kokkos::kokkos)
  set(PLICA_VECTOR_BYTES 16)
  foreach(width 32:AVX2 64:AVX512F)
    string(REGEX MATCH "(.*):(.*)" _ ${width})
    set(has PLICA_HAS_${CMAKE_MATCH_2}_NATIVE_${PLICA_NATIVE})
    check_cxx_source_compiles("#ifndef __${CMAKE_MATCH_2}__\n#error\n#endif\nint main() {}" ${has})
    if(${has})
      set(PLICA_VECTOR_BYTES ${CMAKE_MATCH_1})
    endif()
  endforeach()
  unset(CMAKE_REQUIRED_FLAGS)
  unset(CMAKE_REQUIRED_LIBRARIES)
  if(PLICA_VECTOR_BYTES EQUAL 64)
    target_compile_options(plica_options INTERFACE -mprefer-vector-width=512)
  endif()
endif()
