// Catch2's main, where the library is not to be had for the target.
#define CATCH_CONFIG_MAIN
#include <catch2/catch.hpp>
