// The part of the report that shows a sweep.
#pragma once

#include <string>

#include "compare/report.h"

namespace shoal {

std::string sweep_section(const ReportSweep& sweep);

}  // namespace shoal
