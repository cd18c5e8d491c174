#include "water/surface_keys.h"

namespace shoal {
namespace {

template <class T>
std::optional<double> as_double(const std::optional<T>& value) {
  if (!value) return std::nullopt;
  return static_cast<double>(*value);
}

// One entry each; slope and amplitude put one another out.
#define SHOAL_SURFACE_FLOAT(member)                                                                \
  [](const SurfaceSettings& s) -> std::optional<double> { return static_cast<double>(s.member); }, \
      [](SurfaceSettings& s, double v) { s.member = static_cast<decltype(s.member)>(v); }
#define SHOAL_SURFACE_OPTIONAL(member, type)                    \
  [](const SurfaceSettings& s) { return as_double(s.member); }, \
      [](SurfaceSettings& s, double v) { s.member = static_cast<type>(v); }

}  // namespace

const std::vector<SurfaceKindInfo>& surface_kinds() {
  static const std::vector<SurfaceKindInfo> kinds = {
      {SurfaceKind::kFlat, "flat", "still water: the plane itself"},
      {SurfaceKind::kPerlin, "perlin", "fractal gradient noise (Li et al.)"},
      {SurfaceKind::kGradientWaves, "gradient-waves", "two drifting layers of gradient noise (Steel 2024)"},
      {SurfaceKind::kRipples, "ripples", "rings of falling drops (Champandard 1999)"},
      {SurfaceKind::kRippleFilter, "ripple-filter", "drops in a basin by the blur-sharpen filter (Champandard 1999)"},
      {SurfaceKind::kGerstner, "gerstner", "trochoidal waves as a height field (Gerstner 1809)"},
      {SurfaceKind::kSpectrum, "spectrum", "a wind sea by Fourier transform, without chop (Tessendorf 2001)"},
  };
  return kinds;
}

const char* surface_kind_name(SurfaceKind kind) {
  for (const SurfaceKindInfo& info : surface_kinds()) {
    if (info.kind == kind) return info.name;
  }
  return "sum";
}

const std::vector<SurfaceNumber>& surface_numbers() {
  static const std::vector<SurfaceNumber> numbers = {
      {"slope", 0, 2, false, "the RMS slope, 0 to 2", [](const SurfaceSettings& s) { return as_double(s.slope); },
       [](SurfaceSettings& s, double v) {
         s.slope = static_cast<float>(v);
         s.amplitude_m.reset();
       }},
      {"amplitude", 0, 100, false, "metres, 0 to 100",
       [](const SurfaceSettings& s) { return as_double(s.amplitude_m); },
       [](SurfaceSettings& s, double v) {
         s.amplitude_m = static_cast<float>(v);
         s.slope.reset();
       }},
      {"wavelength", 1e-3, 1e5, false, "metres, 0.001 to 100000", SHOAL_SURFACE_OPTIONAL(wavelength_m, float)},
      {"octaves", 1, 8, true, "a whole number, 1 to 8", SHOAL_SURFACE_OPTIONAL(octaves, int)},
      {"lacunarity", 1, 4, false, "a number, 1 to 4", SHOAL_SURFACE_FLOAT(lacunarity)},
      {"gain", 0, 1, false, "a number, 0 to 1", SHOAL_SURFACE_FLOAT(gain)},
      {"speed", 0, 1000, false, "a factor on time, 0 to 1000", SHOAL_SURFACE_FLOAT(speed)},
      {"seed", 0, 4294967295.0, true, "a whole number, 0 to 4294967295", SHOAL_SURFACE_FLOAT(seed)},
      {"sources", 1, 256, true, "a whole number, 1 to 256", SHOAL_SURFACE_FLOAT(sources)},
      {"reach", 1e-3, 1e6, false, "metres, 0.001 to 1000000", SHOAL_SURFACE_OPTIONAL(reach_m, float)},
      {"lifetime", 1e-2, 1e6, false, "seconds, 0.01 to 1000000", SHOAL_SURFACE_FLOAT(lifetime_s)},
      {"grid", 0, 1024, true, "points a side, 2 to 1024, or 0", SHOAL_SURFACE_FLOAT(grid)},
      {"choppiness", 0, 1, false, "a number, 0 to 1", SHOAL_SURFACE_FLOAT(choppiness)},
      {"direction", -360, 360, false, "degrees, -360 to 360", SHOAL_SURFACE_FLOAT(direction_deg)},
      {"period", 1e-2, 1e6, false, "metres, 0.01 to 1000000", SHOAL_SURFACE_OPTIONAL(tile_m, float)},
  };
  return numbers;
}
#undef SHOAL_SURFACE_FLOAT
#undef SHOAL_SURFACE_OPTIONAL

const SurfaceNumber* find_surface_number(std::string_view name) {
  for (const SurfaceNumber& key : surface_numbers()) {
    if (name == key.name) return &key;
  }
  return nullptr;
}

const std::vector<SurfaceChoice>& surface_choices() {
  static const std::vector<SurfaceChoice> choices = {
      {"fade",
       {"quintic", "cubic"},
       [](const SurfaceSettings& s) { return static_cast<std::size_t>(s.fade); },
       [](SurfaceSettings& s, std::size_t v) { s.fade = static_cast<NoiseFade>(v); }},
      {"falloff",
       {"linear", "exponential"},
       [](const SurfaceSettings& s) { return static_cast<std::size_t>(s.falloff); },
       [](SurfaceSettings& s, std::size_t v) { s.falloff = static_cast<RippleFalloff>(v); }},
      {"filter",
       {"footprint", "none"},
       [](const SurfaceSettings& s) { return static_cast<std::size_t>(s.filter); },
       [](SurfaceSettings& s, std::size_t v) { s.filter = static_cast<WaveFilter>(v); }},
  };
  return choices;
}

const SurfaceChoice* find_surface_choice(std::string_view name) {
  for (const SurfaceChoice& key : surface_choices()) {
    if (name == key.name) return &key;
  }
  return nullptr;
}

void set_surface_number(SurfaceSettings& settings, const SurfaceNumber& key, double value) {
  if (settings.kind == SurfaceKind::kSum && std::string_view(key.name) != "slope") {
    for (SurfaceSettings& part : settings.parts) key.set(part, value);
    return;
  }
  key.set(settings, value);
}

void set_surface_choice(SurfaceSettings& settings, const SurfaceChoice& key, std::size_t value) {
  key.set(settings, value);
  for (SurfaceSettings& part : settings.parts) key.set(part, value);
}

void set_surface_kinds(SurfaceSettings& settings, const std::vector<SurfaceKind>& kinds) {
  settings.parts.clear();
  settings.kind = kinds.size() == 1 ? kinds[0] : SurfaceKind::kSum;
  if (kinds.size() < 2) return;
  SurfaceSettings part = settings;
  part.slope.reset();
  part.amplitude_m.reset();
  for (const SurfaceKind kind : kinds) {
    part.kind = kind;
    settings.parts.push_back(part);
  }
  settings.amplitude_m.reset();
}

}  // namespace shoal
