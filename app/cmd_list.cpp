// shoal list: names, one a line, for people and scripts.
#include <fmt/format.h>

#include "app/commands.h"
#include "app/output.h"
#include "core/error.h"
#include "water/surface_keys.h"

namespace shoal::app {

int run_list(const std::string& kind) {
  std::string lines;
  if (kind == "methods") {
    for (const MethodInfo& m : method_infos())
      lines += fmt::format("{:<16} {} ({}){}\n", m.name, m.description, m.source,
                           m.portable ? "" : "; not the same bytes on every machine");
  } else if (kind == "surfaces") {
    for (const SurfaceKindInfo& s : surface_kinds()) lines += fmt::format("{:<16} {}\n", s.name, s.description);
  } else if (kind == "scenes") {
    for (const ProceduralScene& s : procedural_scenes()) lines += fmt::format("{:<16} {}\n", s.name, s.description);
  } else if (kind == "isas") {
    for (const Isa isa : supported_isas()) lines += fmt::format("{}\n", isa_name(isa));
  } else {
    throw UsageError(fmt::format("list '{}': unknown; expected one of: methods, surfaces, scenes, isas", kind));
  }
  write_stdout(lines);
  return 0;
}

}  // namespace shoal::app
