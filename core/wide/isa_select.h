// Which instruction set this translation unit is compiled for, and the namespace of its kernels.
//
// A kernel file is compiled once an ISA with SHOAL_ISA_<NAME> defined (cmake/ShoalIsa.cmake) and opens
//   namespace shoal::inline SHOAL_ISA_NS { ... }
// so that its code sees plain names and the linker sees different ones. A file compiled without that definition
// (a user's own, a test) gets the best ISA that its compile flags allow.
#pragma once

#if !defined(SHOAL_ISA_SCALAR) && !defined(SHOAL_ISA_SSE42) && !defined(SHOAL_ISA_AVX2) && \
    !defined(SHOAL_ISA_AVX512) && !defined(SHOAL_ISA_NEON)
#if defined(__AVX512F__) && defined(__AVX512BW__) && defined(__AVX512DQ__) && defined(__AVX512VL__)
#define SHOAL_ISA_AVX512 1
#elif defined(__AVX2__)
#define SHOAL_ISA_AVX2 1
#elif defined(__SSE4_2__)
#define SHOAL_ISA_SSE42 1
#elif defined(__aarch64__)
#define SHOAL_ISA_NEON 1
#else
#define SHOAL_ISA_SCALAR 1
#endif
#endif

#if defined(SHOAL_ISA_AVX512)
#define SHOAL_ISA_NS isa_avx512
#elif defined(SHOAL_ISA_AVX2)
#define SHOAL_ISA_NS isa_avx2
#elif defined(SHOAL_ISA_SSE42)
#define SHOAL_ISA_NS isa_sse42
#elif defined(SHOAL_ISA_NEON)
#define SHOAL_ISA_NS isa_neon
#else
#define SHOAL_ISA_NS isa_scalar
#endif

// Everything that kernels include and that is not in SHOAL_ISA_NS must never be emitted out of line, or the linker
// could pick the AVX-512 copy of it for all.
#if defined(SHOAL_ISA_SCALAR)
// Sixteen scalar lanes inlined everywhere take GCC eight times as long to compile; every machine runs this copy.
#define SHOAL_INLINE inline
#else
#define SHOAL_INLINE inline __attribute__((always_inline))
#endif

// The same for a lambda: [&](...) SHOAL_LAMBDA { ... }.
#define SHOAL_LAMBDA __attribute__((always_inline))
