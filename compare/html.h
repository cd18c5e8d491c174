// Pieces of a web page.
#pragma once

#include <string>
#include <string_view>

namespace shoal {

// Text as content or as a quoted attribute.
std::string html_escape(std::string_view text);

std::string base64(std::string_view bytes);

// Three significant digits, no exponent within 1e-4 to 1e6; a dash for what is not finite.
std::string short_number(double value);

// A share of 1 as "12.3 %".
std::string percent(double share);

}  // namespace shoal
