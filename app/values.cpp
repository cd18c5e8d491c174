#include "app/values.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "core/error.h"

namespace shoal::app {
namespace {

constexpr int kMaxSize = 16384;
constexpr std::int64_t kMaxFrame = 999'999'999;

[[noreturn]] void refuse(std::string_view option, std::string_view text, std::string_view expected) {
  throw UsageError(fmt::format("{} '{}': not understood; expected {}", option, text, expected));
}

// The whole of `text` as a number, or false.
template <class T>
bool read_whole(std::string_view text, T& value) {
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  return error == std::errc() && stop == end && !text.empty();
}

bool read_digits(std::string_view text, std::int64_t& value) {
  return !text.empty() && text[0] != '-' && read_whole(text, value);
}

bool is_digit(char c) { return c >= '0' && c <= '9'; }

}  // namespace

std::int64_t read_integer(std::string_view option, std::string_view text, std::int64_t low, std::int64_t high) {
  std::int64_t value = 0;
  if (!read_whole(text, value) || value < low || value > high) {
    refuse(option, text, fmt::format("a whole number from {} to {}", low, high));
  }
  return value;
}

double read_number(std::string_view option, std::string_view text, double low, double high) {
  double value = 0;
  if (!read_whole(text, value) || !std::isfinite(value) || !(value >= low && value <= high)) {
    refuse(option, text, fmt::format("a number from {} to {}", low, high));
  }
  return value;
}

float read_float(std::string_view option, std::string_view text, double low, double high) {
  return static_cast<float>(read_number(option, text, low, high));
}

std::vector<float> read_floats(std::string_view option, std::string_view text, std::size_t count, double low,
                               double high) {
  std::string_view list = text;
  if (list.size() >= 2 && list.front() == '[' && list.back() == ']') list = list.substr(1, list.size() - 2);
  const std::vector<std::string> parts = split(list, ',');
  if (parts.size() != count) refuse(option, text, fmt::format("{} numbers with commas between them", count));
  std::vector<float> values;
  for (const std::string& part : parts) {
    double value = 0;
    if (!read_whole(part, value) || !std::isfinite(value) || !(value >= low && value <= high)) {
      refuse(option, text, fmt::format("{} numbers from {} to {}, commas between them", count, low, high));
    }
    values.push_back(static_cast<float>(value));
  }
  return values;
}

Vec3f read_triple(std::string_view option, std::string_view text, double low, double high) {
  const std::vector<float> v = read_floats(option, text, 3, low, high);
  return {v[0], v[1], v[2]};
}

SizePx read_size(std::string_view option, std::string_view text) {
  const std::size_t cross = text.find('x');
  std::int64_t width = 0, height = 0;
  if (cross == std::string_view::npos || !read_digits(text.substr(0, cross), width) ||
      !read_digits(text.substr(cross + 1), height) || width < 1 || width > kMaxSize || height < 1 ||
      height > kMaxSize) {
    refuse(option, text, fmt::format("WxH in pixels, such as 1280x720, each from 1 to {}", kMaxSize));
  }
  return {static_cast<int>(width), static_cast<int>(height)};
}

FrameRange read_frames(std::string_view option, std::string_view text) {
  const std::size_t colon = text.find(':');
  FrameRange range;
  if (colon == std::string_view::npos || !read_digits(text.substr(0, colon), range.first) ||
      !read_digits(text.substr(colon + 1), range.last) || range.last > kMaxFrame || range.first > range.last) {
    refuse(option, text, fmt::format("A:B, the first and the last frame, 0 <= A <= B <= {}", kMaxFrame));
  }
  return range;
}

std::vector<std::string> split(std::string_view text, char separator) {
  std::vector<std::string> parts;
  for (;;) {
    const std::size_t at = text.find(separator);
    parts.emplace_back(text.substr(0, at));
    if (at == std::string_view::npos) return parts;
    text.remove_prefix(at + 1);
  }
}

bool has_ending(std::string_view path, std::string_view ending) {
  if (path.size() < ending.size()) return false;
  const std::string_view tail = path.substr(path.size() - ending.size());
  for (std::size_t i = 0; i < tail.size(); ++i) {
    const char c = tail[i] >= 'A' && tail[i] <= 'Z' ? static_cast<char>(tail[i] - 'A' + 'a') : tail[i];
    if (c != ending[i]) return false;
  }
  return true;
}

std::string join(const std::vector<std::string>& names) { return fmt::format("{}", fmt::join(names, ", ")); }

NamePattern::NamePattern(std::string_view option, std::string_view text) {
  constexpr std::string_view kExpected = "a file name with one integer conversion, such as frame.%04d.png";
  constexpr int kMaxWidth = 32;
  bool found = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    std::string& part = found ? after_ : before_;
    if (text[i] != '%') {
      part += text[i];
      continue;
    }
    if (++i < text.size() && text[i] == '%') {
      part += '%';
      continue;
    }
    if (found) refuse(option, text, kExpected);
    if (i < text.size() && text[i] == '0') fill_ = '0';
    for (; i < text.size() && is_digit(text[i]) && width_ <= kMaxWidth; ++i) width_ = width_ * 10 + (text[i] - '0');
    if (i >= text.size() || text[i] != 'd' || width_ > kMaxWidth) refuse(option, text, kExpected);
    found = true;
  }
  if (!found) refuse(option, text, kExpected);
}

std::string NamePattern::name(std::int64_t number) const {
  std::string digits = fmt::format("{}", number);
  if (digits.size() < static_cast<std::size_t>(width_)) {
    digits.insert(0, static_cast<std::size_t>(width_) - digits.size(), fill_);
  }
  return before_ + digits + after_;
}

}  // namespace shoal::app
