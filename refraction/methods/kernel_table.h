// All kernels of one ISA: kernel_table_isa_avx512() and so on, defined by refraction/methods/kernel_table.isa.cpp.
#pragma once

#include <cstddef>

#include "refraction/kernels.h"

#define SHOAL_PASTE_NAME(a, b) a##b
#define SHOAL_PASTE(a, b) SHOAL_PASTE_NAME(a, b)

namespace shoal {

struct KernelTable {
  FrameKernels frame;
  const Method* methods;
  std::size_t method_count;
};

const KernelTable& kernel_table_isa_scalar();
#if defined(__x86_64__)
const KernelTable& kernel_table_isa_sse42();
const KernelTable& kernel_table_isa_avx2();
const KernelTable& kernel_table_isa_avx512();
#elif defined(__aarch64__)
const KernelTable& kernel_table_isa_neon();
#endif

}  // namespace shoal
