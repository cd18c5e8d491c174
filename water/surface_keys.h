// The surface's keys by name: what files, the command and reports share.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "water/surface_settings.h"

namespace shoal {

// The largest number of surfaces that a sum may have.
constexpr std::size_t kMaxSurfaceParts = 16;

struct SurfaceKindInfo {
  SurfaceKind kind;
  const char* name;
  const char* description;
};
// What a user may choose, `flat` first. (A sum has no name here: it is `parts`, or names with + between.)
const std::vector<SurfaceKindInfo>& surface_kinds();
// "sum" for a sum.
const char* surface_kind_name(SurfaceKind kind);

// A key whose value is a number within low..high (and a whole one, where `whole`).
struct SurfaceNumber {
  const char* name;
  double low, high;
  bool whole;
  const char* expected;
  std::optional<double> (*get)(const SurfaceSettings& settings);  // empty: the kind's own
  void (*set)(SurfaceSettings& settings, double value);
};
const std::vector<SurfaceNumber>& surface_numbers();
const SurfaceNumber* find_surface_number(std::string_view name);

// A key whose value is one of a few names.
struct SurfaceChoice {
  const char* name;
  std::vector<const char*> values;
  std::size_t (*get)(const SurfaceSettings& settings);
  void (*set)(SurfaceSettings& settings, std::size_t value);
};
const std::vector<SurfaceChoice>& surface_choices();
const SurfaceChoice* find_surface_choice(std::string_view name);

// Sets a number of the surface: of a sum its slope is the whole's, all else is every part's.
void set_surface_number(SurfaceSettings& settings, const SurfaceNumber& key, double value);
void set_surface_choice(SurfaceSettings& settings, const SurfaceChoice& key, std::size_t value);
// The surface becomes of this kind, or the sum of several; other settings stay, and each part of a sum has them but for
// slope and amplitude.
void set_surface_kinds(SurfaceSettings& settings, const std::vector<SurfaceKind>& kinds);

}  // namespace shoal
