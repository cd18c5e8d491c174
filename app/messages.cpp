#include "app/messages.h"

namespace shoal::app {

std::string one_line(std::string_view text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.remove_suffix(1);
  std::string line;
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    const bool control = code < 0x20 || code == 0x7f;
    if (control && !line.empty() && line.back() == ' ') continue;
    line += control ? ' ' : c;
  }
  line += '\n';
  return line;
}

}  // namespace shoal::app
