#include "refraction/data/options.h"

#include <charconv>
#include <cmath>

#include "core/error.h"

namespace shoal {

namespace {

std::string number(float v) {
  char text[32];
  return std::string(text, std::to_chars(text, text + sizeof text, v).ptr);
}

float read(const char* method, const MethodOption& option, const std::string& text) {
  using Kind = MethodOption::Kind;
  if (option.kind == Kind::kBool && (text == "true" || text == "false")) return text == "true" ? 1.0f : 0.0f;
  float value = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  const bool whole = option.kind != Kind::kInt || value == std::floor(value);
  const bool good = error == std::errc() && stop == end && value >= option.min && value <= option.max && whole;
  if (option.kind == Kind::kBool || !good)
    throw UsageError("option '" + std::string(option.key) + "' of " + method + ": '" + text +
                     "' is not allowed; expected " + option_range(option));
  return value;
}

}  // namespace

std::string option_text(const MethodOption& option, float value) {
  if (option.kind == MethodOption::Kind::kBool) return value != 0.0f ? "true" : "false";
  return number(value);
}

std::string option_range(const MethodOption& option) {
  if (option.kind == MethodOption::Kind::kBool) return "true or false";
  const std::string what = option.kind == MethodOption::Kind::kInt ? "a whole number from " : "a number from ";
  return what + number(option.min) + " to " + number(option.max);
}

void read_method_options(const char* method, const OptionList& options, const std::map<std::string, std::string>& given,
                         MethodState& state) {
  if (options.construct != nullptr) options.construct(state.options);
  for (const MethodOption& option : options.fields) {
    const auto found = given.find(option.key);
    if (found != given.end()) option.set(state.options, read(method, option, found->second));
  }
  for (const auto& [key, value] : given) {
    bool known = false;
    for (const MethodOption& option : options.fields) known = known || key == option.key;
    if (!known) throw UsageError("option '" + key + "' is unknown to method " + method);
  }
}

}  // namespace shoal
