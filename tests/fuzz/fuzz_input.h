// What the fuzzers and their replay share.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <span>
#include <string>

namespace shoal::test {

// Gives bytes to the code under test, under tight limits. One definition a fuzzer.
// Returns "loaded", or the message of the Error that refused them. Ends the process where a promise is broken: another
// exception, a message of several lines, a scene that is inconsistent in itself.
std::string outcome_of(std::span<const std::uint8_t> bytes);

inline void promise(bool kept, const char* what) {
  if (kept) return;
  std::fprintf(stderr, "broken promise: %s\n", what);
  std::abort();
}

inline bool is_one_line(const std::string& message) {
  return message.find('\n') == std::string::npos && message.find("; expected ") != std::string::npos;
}

}  // namespace shoal::test

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
