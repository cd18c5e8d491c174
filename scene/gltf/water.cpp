// Reads water, background and environment from extras. docs/scenes.md lists the keys.
#include <algorithm>
#include <cmath>
#include <set>

#include "scene/gltf/internal.h"
#include "water/surface_keys.h"

namespace shoal::gltf {
namespace {

using tinygltf::Value;

// The keys of `extras.water` and flat keys such as `water_ior`. A flat key overrides the other.
constexpr const char* kBodyKeys[] = {"size", "depth", "ior", "absorption", "surface", "geometry"};
template <std::size_t N>
bool is_one_of(const std::string& text, const char* const (&list)[N]) {
  return std::find(std::begin(list), std::end(list), text) != std::end(list);
}

template <std::size_t N>
std::string joined(const char* const (&list)[N]) {
  std::string text;
  for (const char* item : list) text += (text.empty() ? "" : ", ") + std::string(item);
  return text;
}

// The numbers within [min, max], or (min, max] where `above` is set.
struct Range {
  double min, max;
  bool above = false;
  const char* expected;
};

std::vector<float> numbers(const Document& document, const Value& value, std::size_t count, const Range& range,
                           const std::string& what) {
  std::vector<float> result;
  bool ok = true;
  if (value.IsNumber()) {
    ok = count == 1;
    result.push_back(static_cast<float>(value.GetNumberAsDouble()));
  } else {
    ok = value.IsArray() && value.ArrayLen() == count;
    for (std::size_t i = 0; ok && i < count; ++i) {
      const Value& element = value.Get(static_cast<int>(i));
      ok = element.IsNumber();
      result.push_back(ok ? static_cast<float>(element.GetNumberAsDouble()) : 0.0f);
    }
  }
  for (const float number : result) {
    ok = ok && std::isfinite(number) && number >= static_cast<float>(range.min) &&
         number <= static_cast<float>(range.max) && !(range.above && number <= static_cast<float>(range.min));
  }
  if (!ok) fail(document.path, what + " is wrong", std::string("expected ") + range.expected);
  return result;
}

std::string kind_names() {
  std::string text;
  for (const SurfaceKindInfo& info : surface_kinds()) text += (text.empty() ? "" : ", ") + std::string(info.name);
  return text;
}

// Reads the name of a surface, or of several joined by +, which are added.
void read_surface_type(Document& document, const Value& value, const std::string& what, SurfaceSettings& surface) {
  if (!value.IsString()) fail(document.path, what + " is no name", "expected the type of a surface, such as flat");
  const std::string& type = value.Get<std::string>();
  std::vector<SurfaceKind> kinds;
  for (std::size_t start = 0; start <= type.size();) {
    const std::size_t end = std::min(type.find('+', start), type.size());
    const std::string name = type.substr(start, end - start);
    const auto& infos = surface_kinds();
    const auto info = std::find_if(infos.begin(), infos.end(), [&](const auto& i) { return name == i.name; });
    if (info == infos.end()) fail(document.path, what + " is '" + one_line(type, 40) + "'", "expected " + kind_names());
    kinds.push_back(info->kind);
    if (kinds.size() > kMaxSurfaceParts) {
      fail(document.path, what + " is a sum of more than " + std::to_string(kMaxSurfaceParts) + " surfaces",
           "expected at most " + std::to_string(kMaxSurfaceParts));
    }
    start = end + 1;
  }
  set_surface_kinds(surface, kinds);
}

bool is_surface_key(const std::string& key) {
  return key == "type" || find_surface_number(key) != nullptr || find_surface_choice(key) != nullptr;
}

// Reads the surface's keys except the type, which comes first because the other keys depend on it.
void read_surface_key(Document& document, const std::string& key, const Value& value, const std::string& what,
                      SurfaceSettings& surface) {
  if (const SurfaceNumber* number = find_surface_number(key)) {
    if (!value.IsNumber()) fail(document.path, what + " is no number", std::string("expected ") + number->expected);
    const double v = value.GetNumberAsDouble();
    if (!(v >= number->low && v <= number->high) || (number->whole && v != std::floor(v)))
      fail(document.path, what + " is wrong", std::string("expected ") + number->expected);
    set_surface_number(surface, *number, v);
  } else if (const SurfaceChoice* choice = find_surface_choice(key)) {
    const std::string name = value.IsString() ? value.Get<std::string>() : std::string();
    std::string expected;
    for (std::size_t i = 0; i < choice->values.size(); ++i) {
      if (name == choice->values[i]) {
        set_surface_choice(surface, *choice, i);
        return;
      }
      expected += (i == 0 ? "" : " or ") + std::string(choice->values[i]);
    }
    fail(document.path, what + " is wrong", "expected " + expected);
  }
}

// Warns of a spectrum's grid that the surface does not have as given.
void warn_of_grid(Document& document, const SurfaceSettings& surface, const std::string& label) {
  for (const SurfaceSettings& part : surface.parts) warn_of_grid(document, part, label);
  if (surface.kind != SurfaceKind::kSpectrum || surface.grid == 0) return;
  const int side = resolve_surface(surface).grid;
  if (side == surface.grid) return;
  warn(document, label + " has a spectrum with a grid of " + std::to_string(surface.grid) +
                     " points a side, which is " + "no power of two from 16 to 512: " + std::to_string(side) +
                     " is used");
}

void read_drops(Document& document, const Value& value, const std::string& what, SurfaceSettings& surface) {
  const std::string expected = "a list of [x, z, time], metres and seconds";
  if (!value.IsArray() || value.ArrayLen() > 256) fail(document.path, what + " is wrong", "expected " + expected);
  surface.drops.clear();
  for (std::size_t i = 0; i < value.ArrayLen(); ++i) {
    const auto drop = numbers(document, value.Get(static_cast<int>(i)), 3, {-1e6, 1e6, false, expected.c_str()}, what);
    surface.drops.push_back({drop[0], drop[1], drop[2]});
  }
}

void read_surface(Document& document, const Value& value, const std::string& what, SurfaceSettings& surface,
                  int depth) {
  if (!value.IsObject()) {
    read_surface_type(document, value, what, surface);
    return;
  }
  if (value.Has("parts") && value.Has("type"))
    fail(document.path, what + " has a type and parts", "expected one of them");
  if (value.Has("parts")) {
    const Value& parts = value.Get("parts");
    if (depth > 0 || !parts.IsArray() || parts.ArrayLen() == 0 || parts.ArrayLen() > kMaxSurfaceParts)
      fail(document.path, what + ".parts is wrong", "expected a list of 1 to 16 surfaces without parts of their own");
    surface.kind = SurfaceKind::kSum;
    for (std::size_t i = 0; i < parts.ArrayLen(); ++i) {
      const std::string where = what + ".parts[" + std::to_string(i) + "]";
      SurfaceSettings part;
      read_surface(document, parts.Get(static_cast<int>(i)), where, part, depth + 1);
      if (part.kind == SurfaceKind::kSum) fail(document.path, where + " is a sum", "expected a type without +");
      surface.parts.push_back(part);
    }
  } else if (value.Has("type")) {
    read_surface_type(document, value.Get("type"), what + ".type", surface);
  }
  if (value.Has("slope") && value.Has("amplitude"))
    fail(document.path, what + " has a slope and an amplitude", "expected one of them");
  for (const std::string& key : value.Keys()) {
    const std::string where = what + "." + one_line(key, 40);
    if (key == "type" || key == "parts") continue;
    if (key == "drops") {
      read_drops(document, value.Get(key), where, surface);
    } else if (is_surface_key(key)) {
      read_surface_key(document, key, value.Get(key), where, surface);
    } else {
      warn(document, "water surface key '" + one_line(key, 40) + "' is not known");
    }
  }
}

void read_key(Document& document, const std::string& key, const Value& value, const std::string& what,
              WaterSpec& water) {
  constexpr double kIorMin = 1.0 / 3.0;
  if (key == "size") {
    const auto size = numbers(document, value, 2, {0, 1e9, true, "[x, z] in metres, both more than 0"}, what);
    water.has_size = true;
    water.size_x = size[0];
    water.size_z = size[1];
  } else if (key == "depth") {
    water.has_depth = true;
    water.depth = numbers(document, value, 1, {0, 1e9, true, "metres, more than 0"}, what)[0];
  } else if (key == "ior") {
    water.ior = numbers(document, value, 1, {kIorMin, 3, false, "a number from 1/3 to 3"}, what)[0];
  } else if (key == "absorption") {
    const auto rgb = numbers(document, value, 3, {0, 1e9, false, "[r, g, b] in 1/m, 0 or more"}, what);
    water.absorption = {rgb[0], rgb[1], rgb[2]};
  } else if (key == "surface") {
    read_surface(document, value, what, water.surface, 0);
  } else if (key == "geometry") {
    const std::string name = value.IsString() ? value.Get<std::string>() : std::string();
    if (name != "normals" && name != "displaced")
      fail(document.path, what + " is wrong", "expected normals or displaced");
    water.surface.geometry = name == "normals" ? WaterGeometry::kNormals : WaterGeometry::kDisplaced;
  } else {
    fail(document.path, what + " is no key of water", "expected " + joined(kBodyKeys));
  }
}

Vec3f color(const Document& document, const Value& value, const std::string& what) {
  const auto rgb = numbers(document, value, 3, {0, 1e9, false, "[r, g, b], linear, 0 or more"}, what);
  return {rgb[0], rgb[1], rgb[2]};
}

void read_sky(const Document& document, const Value& value, const std::string& what, Background& sky) {
  sky.kind = Background::Kind::kSky;
  for (const std::string& key : value.Keys()) {
    const std::string where = what + "." + key;
    if (key == "type") {
      if (!value.Get(key).IsString() || value.Get(key).Get<std::string>() != "sky") {
        fail(document.path, where + " is wrong", "expected sky");
      }
    } else if (key == "zenith") {
      sky.zenith = color(document, value.Get(key), where);
    } else if (key == "horizon") {
      sky.horizon = color(document, value.Get(key), where);
    } else if (key == "ground") {
      sky.ground = color(document, value.Get(key), where);
    } else if (key == "sun") {
      sky.sun = color(document, value.Get(key), where);
    } else if (key == "to_sun") {
      const auto v = numbers(document, value.Get(key), 3, {-1.001, 1.001, false, "a unit vector [x, y, z]"}, where);
      const double square =
          (static_cast<double>(v[0]) * v[0] + static_cast<double>(v[1]) * v[1]) + static_cast<double>(v[2]) * v[2];
      if (!(std::fabs(square - 1) < 1e-3)) fail(document.path, where + " is wrong", "expected a unit vector [x, y, z]");
      sky.to_sun_world = {v[0], v[1], v[2]};
    } else {
      fail(document.path, where + " is no key of a sky", "expected type, zenith, horizon, ground, to_sun, sun");
    }
  }
}

}  // namespace

bool read_water(Document& document, const Value& extras, const std::string& label, WaterSpec& water) {
  if (!extras.IsObject()) return false;
  bool is_water = false;
  if (extras.Has("water")) {
    const Value& value = extras.Get("water");
    // Blender exports check boxes as true, older versions as 1.
    if (value.IsBool()) {
      is_water = value.Get<bool>();
    } else if (value.IsNumber()) {
      const double number = value.GetNumberAsDouble();
      if (number != 0 && number != 1)
        fail(document.path, label + ".extras.water is a number", "expected an object, true or false (or 1 or 0)");
      is_water = number == 1;
    } else if (value.IsObject()) {
      is_water = true;
      for (const std::string& key : value.Keys()) {
        read_key(document, key, value.Get(key), label + ".extras.water." + one_line(key, 40), water);
      }
    } else {
      fail(document.path, label + ".extras.water is wrong", "expected an object, true or false");
    }
    if (!is_water) return false;
  }
  const std::string prefix = "water_";
  // The type comes first: the surface's other keys depend on it.
  for (const char* name : {"water_surface", "water_type"}) {
    if (!extras.Has(name)) continue;
    read_surface(document, extras.Get(name), label + ".extras." + name, water.surface, 0);
    is_water = true;
  }
  for (const std::string& name : extras.Keys()) {
    if (name.rfind(prefix, 0) != 0) continue;
    const std::string key = name.substr(prefix.size());
    const std::string what = label + ".extras." + one_line(name, 40);
    if (key == "surface" || key == "type") continue;
    if (is_one_of(key, kBodyKeys)) {
      read_key(document, key, extras.Get(name), what, water);
      is_water = true;
    } else if (is_surface_key(key)) {
      read_surface_key(document, key, extras.Get(name), what, water.surface);
      is_water = true;
    } else {
      warn(document, "extras key '" + one_line(name, 40) + "' is not known");
    }
  }
  if (is_water) warn_of_grid(document, water.surface, label);
  return is_water;
}

void read_background(Document& document, const Value& extras, const std::string& label, Scene& scene) {
  if (!extras.IsObject() || !extras.Has("background")) return;
  const Value& value = extras.Get("background");
  const std::string what = label + ".extras.background";
  Background background;
  if (value.IsArray()) {
    background.color = color(document, value, what);
  } else if (value.IsObject()) {
    read_sky(document, value, what, background);
  } else if (value.IsString() && value.Get<std::string>() == "sky") {
    background.kind = Background::Kind::kSky;
  } else {
    fail(document.path, what + " is wrong", "expected \"sky\", [r, g, b], or an object with the sky's colours");
  }
  scene.has_background = true;
  scene.background = background;
}

void read_environment(Document& document, const Value& extras, const std::string& label, Scene& scene) {
  if (!extras.IsObject() || !extras.Has("environment")) return;
  const Value& value = extras.Get("environment");
  const std::string what = label + ".extras.environment";
  const std::string uri = value.IsString() ? value.Get<std::string>() : std::string();
  if (uri.empty() || uri.rfind("data:", 0) == 0)
    fail(document.path, what + " is wrong", "expected the URI of an equirectangular picture's file");
  scene.environment_file = resolve_uri(document, uri, what);
}

}  // namespace shoal::gltf
