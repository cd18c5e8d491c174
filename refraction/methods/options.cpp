#include "refraction/methods/options.h"

#include <charconv>
#include <cmath>

#include "core/error.h"

namespace shoal {

namespace {

std::string number(float v) {
  char text[32];
  return std::string(text, std::to_chars(text, text + sizeof text, v).ptr);
}

std::string expected(const MethodOption& option) {
  if (option.kind == MethodOption::Kind::kBool) return "true or false";
  const std::string what = option.kind == MethodOption::Kind::kInt ? "a whole number from " : "a number from ";
  return what + number(option.least) + " to " + number(option.most);
}

float read(const Method& method, const MethodOption& option, const std::string& text) {
  using Kind = MethodOption::Kind;
  if (option.kind == Kind::kBool && (text == "true" || text == "false")) return text == "true" ? 1.0f : 0.0f;
  float value = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  const bool whole = option.kind != Kind::kInt || value == std::floor(value);
  const bool good = error == std::errc() && stop == end && value >= option.least && value <= option.most && whole;
  if (option.kind == Kind::kBool || !good)
    throw UsageError("option '" + std::string(option.key) + "' of " + method.name + ": '" + text +
                     "' is not allowed; expected " + expected(option));
  return value;
}

}  // namespace

void read_method_options(const Method& method, const std::map<std::string, std::string>& given,
                         float (&values)[kMaxMethodOptions]) {
  for (std::size_t i = 0; i < method.option_count; ++i) {
    const MethodOption& option = method.options[i];
    const auto found = given.find(option.key);
    values[i] = read(method, option, found == given.end() ? option.standard : found->second);
  }
  for (const auto& [key, value] : given) {
    bool known = false;
    for (std::size_t i = 0; i < method.option_count; ++i) known = known || key == method.options[i].key;
    if (!known) throw UsageError("option '" + key + "' is unknown to method " + method.name);
  }
}

}  // namespace shoal
