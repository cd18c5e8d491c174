// Prints the best instruction set that the machine runs, by the command's own rule. cmake/ShoalIsa.cmake runs it for
// SHOAL_ISAS=native, with every SHOAL_BUILDS_<NAME> of the target defined.
#include <cstdio>

#include "core/isa.cpp"

int main() { std::puts(shoal::isa_name(shoal::best_isa())); }
