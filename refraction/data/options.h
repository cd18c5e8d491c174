// A method's options: a plain struct with defaults, and a table of its fields for `--set KEY=VALUE` and for lists.
//
//   struct Options { int steps = 4; bool pom = false; float stop = 0.5f; };
//   constexpr MethodOption kOptions[] = {
//       method_option<&Options::steps>("steps", 1, 64, "steps of the fixed point"),
//       method_option<&Options::pom>("pom", "march to the surface that the bent ray hits")};
#pragma once

#include <cstdint>
#include <map>
#include <new>
#include <span>
#include <string>
#include <type_traits>

#include "refraction/data/method_state.h"

namespace shoal {

// One field of a method's option struct. Values are numbers: those of kBool are 0 and 1.
struct MethodOption {
  enum class Kind : std::uint8_t { kBool, kInt, kFloat };
  const char* key;
  const char* meaning;
  Kind kind;
  float min, max, default_value;
  void (*set)(void* options, float value);
};

namespace option_detail {
template <class T>
struct Member;
template <class Options, class Field>
struct Member<Field Options::*> {
  using OptionsType = Options;
  using FieldType = Field;
};
// Internal to each file: methods may give their option structs the same name, each in an unnamed namespace of its own,
// and GCC 12 would merge the functions of two such structs as one.
template <auto field>
static void set(void* options, float value) {
  using M = Member<decltype(field)>;
  static_cast<typename M::OptionsType*>(options)->*field = static_cast<typename M::FieldType>(value);
}
template <class Options>
static void construct(void* options) {
  new (options) Options();
}
}  // namespace option_detail

//   field     a member of the option struct: bool, int or float; its initial value is the default
//   min, max  of the values allowed
//   meaning   one sentence without its full stop
template <auto field>
static constexpr MethodOption method_option(const char* key, float min, float max, const char* meaning) {
  using M = option_detail::Member<decltype(field)>;
  using Field = typename M::FieldType;
  constexpr MethodOption::Kind kind = std::is_same_v<Field, bool>  ? MethodOption::Kind::kBool
                                      : std::is_same_v<Field, int> ? MethodOption::Kind::kInt
                                                                   : MethodOption::Kind::kFloat;
  return {
      key, meaning, kind, min, max, static_cast<float>(typename M::OptionsType{}.*field), &option_detail::set<field>};
}
template <auto field>
static constexpr MethodOption method_option(const char* key, const char* meaning) {
  return method_option<field>(key, 0, 1, meaning);
}

// A method's option struct and its fields.
struct OptionList {
  std::span<const MethodOption> fields = {};
  void (*construct)(void* options) = nullptr;  // writes the defaults; null where there are no options
};
template <class Options, std::size_t count>
static constexpr OptionList option_list(const MethodOption (&fields)[count]) {
  static_assert(sizeof(Options) <= kMaxOptionBytes);
  return {fields, &option_detail::construct<Options>};
}

// A value as it would be given: true, 4, 0.5.
std::string option_text(const MethodOption& option, float value);
// What is allowed: "true or false", "a whole number from 1 to 64", "a number from 0 to 1".
std::string option_range(const MethodOption& option);

// Sets a method's options to their defaults, then to the given values.
//   method  the name, for messages
// Throws UsageError for a key that the method does not have, and for a value that is not of its kind or out of range.
void read_method_options(const char* method, const OptionList& options, const std::map<std::string, std::string>& given,
                         MethodState& state);

}  // namespace shoal
