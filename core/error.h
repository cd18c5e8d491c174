// The one exception of Shoal, and checks of broken invariants.
#pragma once

#include <stdexcept>
#include <string>

namespace shoal {

// Bad input or a failing machine: one line, "FILE: what is wrong; what was expected". The command prints it and
// exits 1.
struct Error : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// A method that cannot show a scene, by what it is made for.
struct NotApplicable : Error {
  using Error::Error;
};

// Wrong usage of the command or of a setting: exits 2.
struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace shoal
