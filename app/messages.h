// Text for a terminal.
#pragma once

#include <string>
#include <string_view>

namespace shoal::app {

// One line, whatever is in the text: line breaks and other control characters become blanks; a line break at the end.
std::string one_line(std::string_view text);

}  // namespace shoal::app
