// One ISA's part of the registry: methods.def in this ISA's namespace.
#include "refraction/methods/kernel_table.h"

namespace shoal::inline SHOAL_ISA_NS {

#define SHOAL_METHOD(name) Method name();
#include "refraction/methods/methods.def"
#undef SHOAL_METHOD

FrameKernels make_frame_kernels();

}  // namespace shoal::inline SHOAL_ISA_NS

namespace shoal {

const KernelTable& SHOAL_THIS_ISA(kernel_table)() {
  static const Method methods[] = {
#define SHOAL_METHOD(name) name(),
#include "refraction/methods/methods.def"
#undef SHOAL_METHOD
  };
  static const KernelTable table{
      .frame = make_frame_kernels(), .methods = methods, .method_count = sizeof methods / sizeof methods[0]};
  return table;
}

}  // namespace shoal
