#include "compare/html.h"

#include <cmath>
#include <cstdint>
#include <cstdio>

namespace shoal {

std::string html_escape(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&#39;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string base64(std::string_view bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      word = word << 8 | (i + k < bytes.size() ? static_cast<std::uint8_t>(bytes[i + k]) : 0u);
    }
    for (std::size_t k = 0; k < 4; ++k) out += i + k > bytes.size() ? '=' : kDigits[word >> (18 - 6 * k) & 63];
  }
  return out;
}

std::string short_number(double value) {
  if (!std::isfinite(value)) return "\u2013";
  if (value == 0) return "0";
  const double size = std::fabs(value);
  char text[64];
  if (size < 1e-4 || size >= 1e6) {
    std::snprintf(text, sizeof text, "%.2e", value);
  } else {
    // Rounding may carry into the next decade: 9.996 is 10.0.
    int digits = 2 - static_cast<int>(std::floor(std::log10(size)));
    if (std::round(size * std::pow(10.0, digits)) >= 1000) --digits;
    std::snprintf(text, sizeof text, "%.*f", digits > 0 ? digits : 0, value);
  }
  return text;
}

std::string percent(double share) {
  return std::isfinite(share) ? short_number(100 * share) + " %" : short_number(share);
}

}  // namespace shoal
