# Kernels are compiled once an instruction set, each into a namespace of its own (core/wide/isa_select.h).
#
#   shoal_add_kernels(<target> <source>...)
#
# adds the sources to the static library <target> once for every ISA that the target architecture can have, least first.
#
# The hazard: an inline function or template outside of SHOAL_ISA_NS (std::vector's, say) is a weak symbol in every one
# of those objects, and the linker keeps the first copy that it meets. If that were the AVX-512 one, every other ISA
# would call it. So whoever links <target> takes its archive whole (shoal_room), and the archive lists plain sources
# first, then scalar, SSE4.2, AVX2, AVX-512: the copy that is kept is the one that runs everywhere that it is called.
# tests/structure/isa_isolation.sh checks the linked programs.
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  set(all_isas scalar sse42 avx2 avx512)
elseif(CMAKE_SYSTEM_PROCESSOR MATCHES "aarch64|arm64")
  set(all_isas scalar neon)
else()
  set(all_isas scalar)
endif()
# Fewer build faster. `native` is the best one that this machine runs (of a cross-compiler's target: the best one there
# is). The order above holds whatever the order of the list.
set(SHOAL_ISAS "${all_isas}" CACHE STRING "Instruction sets to build kernels for, of: ${all_isas} native")

# shoal_native_isa(<variable>): the name in all_isas that `native` stands for.
function(shoal_native_isa variable)
  list(GET all_isas -1 best)
  if(NOT CMAKE_CROSSCOMPILING)
    set(builds "")
    foreach(isa IN LISTS all_isas)
      string(TOUPPER ${isa} ISA)
      list(APPEND builds -DSHOAL_BUILDS_${ISA}=1)
    endforeach()
    try_run(SHOAL_NATIVE_RAN SHOAL_NATIVE_COMPILED ${PROJECT_BINARY_DIR}/native_isa
            ${PROJECT_SOURCE_DIR}/cmake/native_isa.cpp
            CMAKE_FLAGS -DINCLUDE_DIRECTORIES=${PROJECT_SOURCE_DIR}
            COMPILE_DEFINITIONS ${builds}
            CXX_STANDARD 20 CXX_STANDARD_REQUIRED ON
            COMPILE_OUTPUT_VARIABLE compiled RUN_OUTPUT_VARIABLE best)
    if(NOT SHOAL_NATIVE_COMPILED OR NOT SHOAL_NATIVE_RAN EQUAL 0)
      message(FATAL_ERROR "SHOAL_ISAS=native: cmake/native_isa.cpp failed; name an instruction set instead\n${compiled}${best}")
    endif()
    string(STRIP "${best}" best)
    string(REPLACE . "" best "${best}")  # sse4.2 is sse42 here
  endif()
  set(${variable} ${best} PARENT_SCOPE)
endfunction()

if(native IN_LIST SHOAL_ISAS)
  # The cache keeps the name, so that a later configuration of this folder builds the same.
  if(NOT DEFINED CACHE{SHOAL_NATIVE_ISA})
    shoal_native_isa(native_isa)
    set(SHOAL_NATIVE_ISA ${native_isa} CACHE INTERNAL "What native stands for in SHOAL_ISAS")
  endif()
  message(STATUS "SHOAL_ISAS: native is ${SHOAL_NATIVE_ISA}")
endif()
set(wanted_isas ${SHOAL_ISAS})
list(TRANSFORM wanted_isas REPLACE "^native$" "${SHOAL_NATIVE_ISA}")
foreach(isa IN LISTS wanted_isas)
  if(NOT isa IN_LIST all_isas)
    message(FATAL_ERROR "SHOAL_ISAS: ${isa} is not one of ${all_isas} native")
  endif()
endforeach()
set(SHOAL_ISAS "")
foreach(isa IN LISTS all_isas)
  if(isa IN_LIST wanted_isas)
    list(APPEND SHOAL_ISAS ${isa})
    string(TOUPPER ${isa} ISA)
    target_compile_definitions(shoal_flags INTERFACE SHOAL_BUILDS_${ISA}=1)
  endif()
endforeach()
if(NOT SHOAL_ISAS)
  message(FATAL_ERROR "SHOAL_ISAS is empty; expected some of ${all_isas} native")
endif()

set(SHOAL_FLAGS_scalar "")
set(SHOAL_FLAGS_sse42 -march=x86-64-v2)
set(SHOAL_FLAGS_avx2 -march=x86-64-v3)
set(SHOAL_FLAGS_avx512 -march=x86-64-v4)
set(SHOAL_FLAGS_neon "")

# shoal_use_isa(<target> <isa>): compiles all of <target> for one ISA.
function(shoal_use_isa target isa)
  string(TOUPPER ${isa} ISA)
  target_compile_definitions(${target} PRIVATE SHOAL_ISA_${ISA}=1)
  target_compile_options(${target} PRIVATE ${SHOAL_FLAGS_${isa}})
  if(NOT SHOAL_OPTIMIZE)
    # At -O0 the wide type is some thirty times slower, at GCC's -Og still ten times; at -O1 it can be debugged and used.
    target_compile_options(${target} PRIVATE $<$<CONFIG:Debug>:-O1>)
  endif()
endfunction()

function(shoal_add_kernels target)
  foreach(isa IN LISTS SHOAL_ISAS)
    set(objects ${target}_${isa})
    add_library(${objects} OBJECT ${ARGN})
    shoal_use_isa(${objects} ${isa})
    # Templates that are long and have many callers are compiled once an instruction set (water/exact_ray.isa.cpp).
    target_compile_definitions(${objects} PRIVATE SHOAL_SHARED_TEMPLATES=1)
    target_link_libraries(${objects} PRIVATE shoal_flags)
    list(LENGTH ARGN count)
    if(count GREATER 8)
      shoal_precompile(${objects} <algorithm> <atomic> <memory> <string> <vector> ${PROJECT_SOURCE_DIR}/core/vec.h)
    endif()
    target_sources(${target} PRIVATE $<TARGET_OBJECTS:${objects}>)
  endforeach()
endfunction()
