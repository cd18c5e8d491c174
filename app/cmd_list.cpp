// shoal list: names, one a line, for people and scripts.
#include <fmt/format.h>

#include "app/commands.h"
#include "app/output.h"
#include "core/error.h"
#include "water/surface_keys.h"

namespace shoal::app {

namespace {

// The options of a method, a line each: key, default, what is allowed, meaning.
std::string option_lines(const MethodInfo& method) {
  std::string lines;
  for (const MethodOptionInfo& o : method.options)
    lines += fmt::format("    {:<14} {:<8} {}: {}\n", o.key, o.default_value, o.range, o.meaning);
  return lines;
}

}  // namespace

int run_list(const std::string& kind, bool verbose) {
  std::string lines;
  if (kind == "methods") {
    for (const MethodInfo& m : method_infos()) {
      lines += fmt::format("{:<16} {:<7} {} ({})\n", m.name, m.category, m.description, m.source);
      if (verbose) lines += option_lines(m);
    }
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
