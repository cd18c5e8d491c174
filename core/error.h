// The exceptions that Shoal throws.
#pragma once

#include <stdexcept>
#include <string>

namespace shoal {

// Bad input or a failing machine: one line, "FILE: what is wrong; what was expected". The command prints it and
// exits 1.
struct Error : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// A method that is not applicable to a scene (block-grid, for example, needs a flat floor).
struct NotApplicable : Error {
  using Error::Error;
};

// Wrong usage of the command or of a setting: exits 2.
struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace shoal
