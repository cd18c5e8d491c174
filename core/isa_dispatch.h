// One table of kernels for each instruction set that is built, and the choice of one of them at run time.
//
//   x.h        struct XKernels { void (*run)(...); ... };
//              SHOAL_ISA_TABLE(XKernels, x_kernels)
//   x.isa.cpp  const XKernels& SHOAL_THIS_ISA(x_kernels)() {
//                static constexpr XKernels table{.run = &run, ...};
//                return table;
//              }
//   caller     x_kernels(isa).run(...)
//
// The table function lies in the namespace of SHOAL_ISA_TABLE, outside of SHOAL_ISA_NS; the functions that the table
// points to lie inside of it. A kernel file never calls x_kernels(isa): the linker could keep its copy of that function
// for all (cmake/ShoalIsa.cmake).
#pragma once

#include "core/isa.h"
#include "core/wide/isa_select.h"

// SHOAL_BUILT_ISAS(X, Table, name): X(constant of Isa, namespace, Table, name) for each instruction set that is built,
// least first. cmake/ShoalIsa.cmake defines SHOAL_BUILDS_<NAME>.
#if defined(SHOAL_BUILDS_SCALAR)
#define SHOAL_IF_SCALAR(X, Table, name) X(kScalar, isa_scalar, Table, name)
#else
#define SHOAL_IF_SCALAR(X, Table, name)
#endif
#if defined(SHOAL_BUILDS_SSE42)
#define SHOAL_IF_SSE42(X, Table, name) X(kSse42, isa_sse42, Table, name)
#else
#define SHOAL_IF_SSE42(X, Table, name)
#endif
#if defined(SHOAL_BUILDS_AVX2)
#define SHOAL_IF_AVX2(X, Table, name) X(kAvx2, isa_avx2, Table, name)
#else
#define SHOAL_IF_AVX2(X, Table, name)
#endif
#if defined(SHOAL_BUILDS_AVX512)
#define SHOAL_IF_AVX512(X, Table, name) X(kAvx512, isa_avx512, Table, name)
#else
#define SHOAL_IF_AVX512(X, Table, name)
#endif
#if defined(SHOAL_BUILDS_NEON)
#define SHOAL_IF_NEON(X, Table, name) X(kNeon, isa_neon, Table, name)
#else
#define SHOAL_IF_NEON(X, Table, name)
#endif
#define SHOAL_BUILT_ISAS(X, Table, name) \
  SHOAL_IF_SCALAR(X, Table, name)        \
  SHOAL_IF_SSE42(X, Table, name)         \
  SHOAL_IF_AVX2(X, Table, name)          \
  SHOAL_IF_AVX512(X, Table, name) SHOAL_IF_NEON(X, Table, name)

// Declares the table functions name_isa_scalar(), name_isa_avx2(), ... and defines
//   const Table& name(Isa isa)
//     isa  one of supported_isas(); throws UsageError where it is not built
#define SHOAL_ISA_TABLE(Table, name)                      \
  SHOAL_BUILT_ISAS(SHOAL_ISA_TABLE_DECLARE, Table, name)  \
  inline const Table& name(::shoal::Isa isa) {            \
    switch (isa) {                                        \
      SHOAL_BUILT_ISAS(SHOAL_ISA_TABLE_CASE, Table, name) \
      default:                                            \
        ::shoal::throw_isa_not_built(isa);                \
    }                                                     \
  }
#define SHOAL_ISA_TABLE_DECLARE(kind, isa_namespace, Table, name) const Table& name##_##isa_namespace();
#define SHOAL_ISA_TABLE_CASE(kind, isa_namespace, Table, name) \
  case ::shoal::Isa::kind:                                     \
    return name##_##isa_namespace();

// The name of a table function in the file that defines it for its own instruction set: SHOAL_THIS_ISA(x_kernels) is
// x_kernels_isa_avx2 where the file is compiled for AVX2.
#define SHOAL_THIS_ISA(name) SHOAL_THIS_ISA_JOIN(name, SHOAL_ISA_NS)
#define SHOAL_THIS_ISA_JOIN(name, isa_namespace) SHOAL_THIS_ISA_PASTE(name, isa_namespace)
#define SHOAL_THIS_ISA_PASTE(name, isa_namespace) name##_##isa_namespace
