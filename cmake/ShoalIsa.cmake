# Kernels are compiled once an instruction set, each into a namespace of its own (core/wide/isa_select.h).
#
#   shoal_add_kernels(<target> <source>...)
#
# adds the sources to <target> once for every ISA that the target architecture can have. The scalar objects come first,
# so that a weak symbol shared by several of them (there should be none) resolves to the one that runs everywhere.
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  set(SHOAL_ISAS scalar sse42 avx2 avx512)
elseif(CMAKE_SYSTEM_PROCESSOR MATCHES "aarch64|arm64")
  set(SHOAL_ISAS scalar neon)
else()
  set(SHOAL_ISAS scalar)
endif()

set(SHOAL_FLAGS_scalar "")
set(SHOAL_FLAGS_sse42 -march=x86-64-v2)
set(SHOAL_FLAGS_avx2 -march=x86-64-v3)
set(SHOAL_FLAGS_avx512 -march=x86-64-v4)
set(SHOAL_FLAGS_neon "")

function(shoal_add_kernels target)
  foreach(isa IN LISTS SHOAL_ISAS)
    string(TOUPPER ${isa} ISA)
    set(objects ${target}_${isa})
    add_library(${objects} OBJECT ${ARGN})
    target_compile_definitions(${objects} PRIVATE SHOAL_ISA_${ISA}=1)
    target_compile_options(${objects} PRIVATE ${SHOAL_FLAGS_${isa}})
    target_link_libraries(${objects} PRIVATE shoal_flags)
    target_sources(${target} PRIVATE $<TARGET_OBJECTS:${objects}>)
  endforeach()
endfunction()
