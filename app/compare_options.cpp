#include "app/compare_options.h"

#include <fmt/format.h>

#include <algorithm>

#include "compare/flip.h"
#include "core/error.h"

namespace shoal::app {
namespace {

using Names = std::vector<std::string>;

bool has_option(const MethodInfo& method, const std::string& key) {
  return std::any_of(method.options.begin(), method.options.end(), [&](const auto& o) { return o.key == key; });
}

bool is_method(const std::string& name) {
  return std::any_of(method_infos().begin(), method_infos().end(), [&](const MethodInfo& m) { return name == m.name; });
}

// Does any of these methods have the option, and does this one not?
bool belongs_to_another(const std::string& key, const std::string& method, const Names& compared) {
  bool others = false;
  for (const MethodInfo& info : method_infos()) {
    if (!has_option(info, key)) continue;
    if (info.name == method) return false;
    others = others || std::find(compared.begin(), compared.end(), info.name) != compared.end();
  }
  return others;
}

// What `shoal render --method NAME` would be given: an option that only other methods have is left to them.
RawOptions raw_of(const RawOptions& common, const std::string& method, const Names& compared) {
  RawOptions raw = common;
  raw.output.reset();
  raw.methods.reset();
  raw.reference.reset();
  raw.method = method;
  raw.set.clear();
  for (const std::string& text : common.set) {
    if (!belongs_to_another(text.substr(0, text.find('=')), method, compared)) raw.set.push_back(text);
  }
  return raw;
}

Names compared_methods(const RawOptions& raw, const std::string& reference) {
  Names names;
  if (raw.methods) {
    names = split(*raw.methods, ',');
    for (const std::string& name : names) {
      if (std::count(names.begin(), names.end(), name) > 1) {
        throw UsageError(fmt::format("--methods '{}': has {} twice; expected each once", *raw.methods, name));
      }
    }
    return names;
  }
  for (const MethodInfo& info : method_infos()) {
    if (info.name != reference) names.emplace_back(info.name);
  }
  if (names.empty()) throw UsageError("--methods: there is none but the reference; expected --methods A,B");
  return names;
}

// What read_options says of --method is said of the option that was typed.
Options read_named(const RawOptions& raw, const char* option) {
  try {
    return read_options(raw);
  } catch (const UsageError& error) {
    const std::string what = error.what(), typed = "--method ";
    if (what.rfind(typed, 0) != 0) throw;
    throw UsageError(std::string(option) + what.substr(typed.size() - 1));
  }
}

SweepOptions read_sweep(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) {
    throw UsageError(fmt::format("--sweep '{}': not understood; expected KEY=A,B,C", text));
  }
  SweepOptions sweep{text.substr(0, equals), split(text.substr(equals + 1), ',')};
  for (const std::string& value : sweep.values) {
    if (value.empty()) throw UsageError(fmt::format("--sweep '{}': a value is empty; expected KEY=A,B,C", text));
  }
  if (sweep.values.size() > 1000) throw UsageError("--sweep: too many values; expected 1000 at most");
  return sweep;
}

}  // namespace

std::string default_reference() { return is_method("ray-traced") ? "ray-traced" : "hybrid"; }

double read_view_angle(const std::string& value) { return read_number("--sweep view-angle", value, 1, 90); }

CompareOptions read_compare_options(const CompareArguments& arguments) {
  RawOptions raw = arguments.options;
  if (raw.method) throw UsageError("--method: belongs to shoal render; expected --methods A,B");
  if (raw.frames) throw UsageError("--frames: belongs to shoal render; expected --time S");
  if (raw.aov && !arguments.exr) throw UsageError("--aov: a PNG has no layers; expected --exr with it");
  if (!raw.output || raw.output->empty()) {
    throw UsageError("compare: nowhere to write to; expected -o DIR");
  }
  if (!raw.repeat) raw.repeat = kCompareRepeat;
  const std::string reference = raw.reference.value_or(default_reference());
  const Names names = compared_methods(raw, reference);
  Names compared = names;
  compared.push_back(reference);

  CompareOptions options;
  options.folder = *raw.output;
  options.reference = read_named(raw_of(raw, reference, compared), "--reference");
  for (const std::string& name : names) {
    options.methods.push_back(read_named(raw_of(raw, name, compared), "--methods"));
  }
  options.pixels_per_degree = arguments.ppd ? read_float("--ppd", *arguments.ppd, 1, 10000) : kDefaultPixelsPerDegree;
  options.exr = arguments.exr;
  options.yee = arguments.yee;
  if (arguments.sweep) {
    options.sweep = read_sweep(*arguments.sweep);
    // Every point is looked at before the first frame is drawn.
    for (const std::string& value : options.sweep->values) options_at(arguments, options.sweep->key, value);
  }
  return options;
}

CompareOptions options_at(const CompareArguments& arguments, const std::string& key, const std::string& value) {
  CompareArguments at = arguments;
  at.sweep.reset();
  RawOptions& raw = at.options;
  const std::pair<const char*, std::optional<std::string>*> options[] = {
      {"triangles", &raw.triangles},   {"time", &raw.time},       {"spp", &raw.spp},
      {"anisotropy", &raw.anisotropy}, {"size", &raw.size},       {"shadow-map", &raw.shadow_map},
      {"camera", &raw.camera},         {"threads", &raw.threads},
  };
  if (key == kViewAngle) {
    read_view_angle(value);
    return read_compare_options(at);
  }
  for (const auto& [name, option] : options) {
    if (key != name) continue;
    *option = value;
    return read_compare_options(at);
  }
  // Later ones win: the sweep's over what --set says.
  raw.set.push_back(key + "=" + value);
  return read_compare_options(at);
}

}  // namespace shoal::app
