// All kernels of one ISA: kernel_table(isa), defined once an ISA by refraction/kernels_table.cpp.
#pragma once

#include <cstddef>

#include "core/isa_dispatch.h"
#include "refraction/kernels.h"

namespace shoal {

struct KernelTable {
  FrameKernels frame;
  const Method* methods;
  std::size_t method_count;
};

SHOAL_ISA_TABLE(KernelTable, kernel_table)

}  // namespace shoal
