// The registry: which kernels an ISA has, and which methods there are. Adding a method touches methods.def alone.
#include <string>
#include <vector>

#include "core/error.h"
#include "refraction/methods/kernel_table.h"
#include "refraction/methods/method_info.h"

namespace shoal {

const char* category_name(MethodCategory category) {
  constexpr const char* kNames[] = {"raster", "volume", "hybrid", "traced"};
  return kNames[static_cast<std::size_t>(category)];
}

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
      list.push_back({method.name,
                      category_name(method.category),
                      default_reflections(method.category),
                      method.description,
                      method.source,
                      {}});
      for (const MethodOption& option : method.options.fields)
        list.back().options.push_back(
            {option.key, option_text(option, option.default_value), option_range(option), option.meaning});
    }
    return list;
  }();
  return infos;
}

}  // namespace shoal
