// All kernels of one instruction set: kernel_table(isa), defined by refraction/methods/kernel_table.isa.cpp.
#pragma once

#include <cstddef>

#include "core/isa_dispatch.h"
#include "refraction/methods/kernels.h"

namespace shoal {

struct KernelTable {
  FrameKernels frame;
  const Method* methods;
  std::size_t method_count;
};

SHOAL_ISA_TABLE(KernelTable, kernel_table)

}  // namespace shoal
