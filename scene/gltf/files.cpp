// Reads the files that a scene names, within limits and only from the scene's folder.
#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string_view>

#include "scene/gltf/internal.h"

namespace shoal::gltf {
namespace fs = std::filesystem;

std::vector<std::uint8_t> read_file(const std::string& path, std::uint64_t max_bytes, const std::string& blame) {
  std::error_code ec;
  const fs::file_status status = fs::status(path, ec);
  if (ec || status.type() == fs::file_type::not_found) {
    fail(blame, path == blame ? "cannot be opened" : "the file " + path + " cannot be opened",
         "expected a readable file");
  }
  // Directories, devices and pipes have no size that could be checked.
  if (status.type() != fs::file_type::regular) {
    fail(blame, path == blame ? "is no regular file" : path + " is no regular file", "expected a file");
  }
  const std::uint64_t size = fs::file_size(path, ec);
  if (ec) fail(blame, "the size of " + path + " cannot be read", "expected a readable file");
  if (size > max_bytes) {
    fail(blame, path + " has " + std::to_string(size) + " bytes", "expected at most " + std::to_string(max_bytes));
  }
  std::ifstream in(path, std::ios::binary);
  if (!in) {
    fail(blame,
         (path == blame ? std::string("cannot be opened") : "the file " + path + " cannot be opened") + " (" +
             std::strerror(errno) + ")",
         "expected a readable file");
  }
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(size));
  in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (static_cast<std::uint64_t>(in.gcount()) != size) {
    fail(blame, "reading " + path + " stopped early", "expected " + std::to_string(size) + " bytes");
  }
  constexpr std::string_view kLfsPointer = "version https://git-lfs.github.com/spec/";
  if (bytes.size() >= kLfsPointer.size() && std::equal(kLfsPointer.begin(), kLfsPointer.end(), bytes.begin())) {
    fail(blame, (path == blame ? "is" : path + " is") + std::string(" a Git LFS pointer, not the file itself"),
         "expected the file that `git lfs pull` fetches");
  }
  return bytes;
}

namespace {

int hex_value(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

// Decodes percent-encoded characters (RFC 3986, 2.1). A % without two hexadecimal digits is kept.
std::string percent_decoded(const std::string& uri) {
  std::string text;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    if (uri[i] == '%' && i + 2 < uri.size()) {
      const int high = hex_value(uri[i + 1]);
      const int low = hex_value(uri[i + 2]);
      if (high >= 0 && low >= 0) {
        text.push_back(static_cast<char>(high * 16 + low));
        i += 2;
        continue;
      }
    }
    text.push_back(uri[i]);
  }
  return text;
}

bool has_scheme(const std::string& uri) {
  const std::size_t colon = uri.find(':');
  if (colon == std::string::npos || colon == 0) return false;
  for (std::size_t i = 0; i < colon; ++i) {
    const auto c = static_cast<unsigned char>(uri[i]);
    if (!(std::isalnum(c) || c == '+' || c == '-' || c == '.')) return false;
  }
  return std::isalpha(static_cast<unsigned char>(uri[0])) != 0;
}

bool is_below(const fs::path& file, const fs::path& folder) {
  auto f = file.begin();
  for (const fs::path& part : folder) {
    if (part.empty()) continue;  // a trailing slash
    if (f == file.end() || *f != part) return false;
    ++f;
  }
  return f != file.end();
}

}  // namespace

std::string resolve_uri(const Document& document, const std::string& uri, const std::string& label) {
  const std::string inside = "expected a file in the scene's folder";
  if (uri.empty()) fail(document.path, label + " has an empty URI", inside);
  if (has_scheme(uri)) fail(document.path, label + " names '" + one_line(uri, 80) + "'", inside + ", or a data URI");
  const std::string name = percent_decoded(uri);
  if (name.find('\0') != std::string::npos) fail(document.path, label + " has a URI with a null character", inside);
  fs::path relative(name);
  fs::path folder(document.folder.empty() ? "." : document.folder);
  if (!document.limits.allow_external) {
    if (relative.is_absolute() || name.find('\\') != std::string::npos) {
      fail(document.path, label + " names '" + one_line(uri, 80) + "'", inside + ", by a relative path");
    }
    for (const fs::path& part : relative) {
      if (part == "..") fail(document.path, label + " names '" + one_line(uri, 80) + "'", inside + ", without '..'");
    }
  }
  const fs::path full = folder / relative;
  std::error_code ec;
  const fs::path real = fs::canonical(full, ec);
  if (ec) fail(document.path, label + " is missing: " + one_line(full.string(), 200), inside);
  if (!document.limits.allow_external && !is_below(real, fs::canonical(folder, ec))) {
    fail(document.path, label + " leads out of the scene's folder: " + one_line(uri, 80), inside);
  }
  return full.string();
}

}  // namespace shoal::gltf
