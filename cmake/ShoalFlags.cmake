# Compile flags of every Shoal target. They are part of the determinism contract (docs/DETERMINISM.md).
add_library(shoal_flags INTERFACE)
target_compile_features(shoal_flags INTERFACE cxx_std_20)
target_compile_options(shoal_flags INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion
  # No fused multiply-add anywhere: GCC 12 fuses even written-out intrinsics by default.
  -ffp-contract=off
  # Signed overflow never reaches a pixel, but must not become undefined behaviour either.
  -fwrapv
  # These two change no result; they let sqrt and selects become plain instructions.
  -fno-math-errno -fno-trapping-math)
target_include_directories(shoal_flags INTERFACE ${PROJECT_SOURCE_DIR})

if(SHOAL_SANITIZE)
  target_compile_options(shoal_flags INTERFACE -fsanitize=${SHOAL_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(shoal_flags INTERFACE -fsanitize=${SHOAL_SANITIZE})
endif()
