# Compile flags of every Shoal target. They are part of the determinism contract (docs/DETERMINISM.md).
if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Release or Debug" FORCE)
endif()
set(CMAKE_CXX_FLAGS_RELEASE "-O2 -DNDEBUG")
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)

find_package(Threads REQUIRED)

add_library(shoal_flags INTERFACE)
target_compile_features(shoal_flags INTERFACE cxx_std_20)
target_compile_definitions(shoal_flags INTERFACE SHOAL_VERSION="${PROJECT_VERSION}")
target_compile_options(shoal_flags INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion
  # No fused multiply-add anywhere: GCC 12 fuses even written-out intrinsics by default.
  -ffp-contract=off
  # Signed overflow never reaches a pixel, but must not become undefined behaviour either.
  -fwrapv
  # These two change no result; they let sqrt and selects become plain instructions.
  -fno-math-errno -fno-trapping-math
  ${SHOAL_OPTIMIZE})
target_include_directories(shoal_flags INTERFACE ${PROJECT_SOURCE_DIR})
target_link_libraries(shoal_flags INTERFACE Threads::Threads)
if(SHOAL_WERROR)
  target_compile_options(shoal_flags INTERFACE -Werror)
endif()

if(SHOAL_SANITIZE)
  target_compile_options(shoal_flags INTERFACE -fsanitize=${SHOAL_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(shoal_flags INTERFACE -fsanitize=${SHOAL_SANITIZE})
endif()

if(SHOAL_FUZZ)
  if(NOT CMAKE_CXX_COMPILER_ID MATCHES Clang)
    message(FATAL_ERROR "SHOAL_FUZZ needs Clang's libFuzzer: cmake --preset fuzz")
  endif()
  target_compile_options(shoal_flags INTERFACE -fsanitize=fuzzer-no-link)
endif()

# Headers that most files of a target include are parsed once (shoal_precompile). What a file needs it includes itself: with
# -DSHOAL_PRECOMPILE=OFF everything builds the same.
option(SHOAL_PRECOMPILE "Precompile the headers that most files of a target include" ON)

#   shoal_precompile(<target> <header>...)
function(shoal_precompile target)
  if(SHOAL_PRECOMPILE)
    target_precompile_headers(${target} PRIVATE ${ARGN})
  endif()
endfunction()

# Vectors never cross a library boundary by value, so GCC's note on their calling convention is noise.
target_compile_options(shoal_flags INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-psabi>)

# GLM's conversions that lose digits or components (double to float, vec4 to vec3) are written out: Vec3f(v).
target_compile_definitions(shoal_flags INTERFACE GLM_FORCE_EXPLICIT_CTOR)

# Headers of the host that a cross-compiler may see: header-only libraries, one symbolic link each, nothing else of
# /usr/include.
if(CMAKE_CROSSCOMPILING)
  file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/host_headers)
  foreach(header xxhash.h xxh3.h glm catch2)
    if(EXISTS /usr/include/${header})
      file(CREATE_LINK /usr/include/${header} ${PROJECT_BINARY_DIR}/host_headers/${header} SYMBOLIC)
    endif()
  endforeach()
  target_include_directories(shoal_flags SYSTEM INTERFACE ${PROJECT_BINARY_DIR}/host_headers)
endif()
