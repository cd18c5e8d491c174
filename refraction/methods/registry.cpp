// The registry: which kernels an ISA has, and which methods there are. Adding a method touches methods.def alone.
#include <string>
#include <vector>

#include "core/error.h"
#include "refraction/methods/kernel_table.h"
#include "refraction/renderer.h"

namespace shoal {

const FrameKernels& frame_kernels(Isa isa) { return kernel_table(isa).frame; }

const Method& find_method(const std::string& name, Isa isa) {
  const KernelTable& table = kernel_table(isa);
  std::string known;
  for (std::size_t i = 0; i < table.method_count; ++i) {
    if (name == table.methods[i].name) return table.methods[i];
    known += (i == 0 ? "" : ", ") + std::string(table.methods[i].name);
  }
  throw UsageError("method '" + name + "' is unknown; expected one of " + known);
}

const std::vector<MethodInfo>& method_infos() {
  static const std::vector<MethodInfo> infos = [] {
    std::vector<MethodInfo> list;
    const KernelTable& table = kernel_table(best_isa());
    for (std::size_t i = 0; i < table.method_count; ++i) {
      const Method& method = table.methods[i];
      list.push_back({method.name, method.description, method.source, {}, method.portable});
      for (std::size_t k = 0; k < method.option_count; ++k)
        list.back().options.emplace_back(method.options[k].key, method.options[k].standard);
    }
    return list;
  }();
  return infos;
}

}  // namespace shoal
