// The report's style sheet and script, compiled in.
#pragma once

namespace shoal {

extern const char* const kReportStyle;
extern const char* const kReportScript;

}  // namespace shoal
