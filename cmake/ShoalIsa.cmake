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
# Fewer build faster; scalar is always there, and the order above holds whatever is asked for.
set(SHOAL_ISAS "${all_isas}" CACHE STRING "Instruction sets to build kernels for")
foreach(isa IN LISTS SHOAL_ISAS)
  if(NOT isa IN_LIST all_isas)
    message(FATAL_ERROR "SHOAL_ISAS: ${isa} is not one of ${all_isas}")
  endif()
endforeach()
set(asked_isas scalar ${SHOAL_ISAS})
set(SHOAL_ISAS "")
foreach(isa IN LISTS all_isas)
  if(isa IN_LIST asked_isas)
    list(APPEND SHOAL_ISAS ${isa})
    string(TOUPPER ${isa} ISA)
    target_compile_definitions(shoal_flags INTERFACE SHOAL_BUILDS_${ISA}=1)
  endif()
endforeach()

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
  # Vectors never cross a library boundary by value, so GCC's note on their calling convention is noise.
  target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-psabi>)
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
    target_link_libraries(${objects} PRIVATE shoal_flags)
    target_sources(${target} PRIVATE $<TARGET_OBJECTS:${objects}>)
  endforeach()
endfunction()
