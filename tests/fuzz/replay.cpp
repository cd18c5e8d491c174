// Runs what a fuzzer has been given, without the fuzzer: every file of each folder named, in alphabetical order. Of a
// file that is named itself, what comes of it is printed. A folder with an `expected.txt` says what comes of each of
// its files: lines `FILE: loaded`, or `FILE: ` and a part of the message that refuses it.
#include <algorithm>
#include <exception>
#include <filesystem>
#include <fstream>
#include <map>
#include <vector>

#include "tests/fuzz/fuzz_input.h"
#include "tests/scene/bad_files.h"

namespace shoal::test {
namespace {

namespace fs = std::filesystem;

constexpr const char* kExpected = "expected.txt";

std::map<std::string, std::string> read_expected(const fs::path& folder) {
  std::map<std::string, std::string> expected;
  std::ifstream in(folder / kExpected);
  for (std::string line; std::getline(in, line);) {
    const std::size_t colon = line.find(": ");
    if (colon != std::string::npos) expected[line.substr(0, colon)] = line.substr(colon + 2);
  }
  return expected;
}

// The number of failures.
int replay(const fs::path& folder, int& count) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.path().filename() != kExpected) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  std::map<std::string, std::string> expected = read_expected(folder);
  const bool all_expected = fs::exists(folder / kExpected);
  int failures = 0;
  const auto complain = [&](const std::string& name, const std::string& what) {
    std::fprintf(stderr, "%s: %s\n", (folder / name).c_str(), what.c_str());
    ++failures;
  };
  for (const fs::path& file : files) {
    const std::string name = file.filename().string();
    const std::string outcome = outcome_of(read_whole_file(file.string()));
    ++count;
    const auto it = expected.find(name);
    if (it == expected.end()) {
      if (all_expected) complain(name, std::string("not listed in ") + kExpected);
      continue;
    }
    const bool as_expected =
        it->second == "loaded" ? outcome == "loaded" : outcome.find(it->second) != std::string::npos;
    if (!as_expected) complain(name, "expected: " + it->second + "; got: " + outcome);
    expected.erase(it);
  }
  for (const auto& [name, outcome] : expected) complain(name, "listed, but not there");
  return failures;
}

}  // namespace
}  // namespace shoal::test

int main(int argc, char** argv) {
  int count = 0, failures = 0;
  try {
    for (int i = 1; i < argc; ++i) {
      if (std::filesystem::is_directory(argv[i])) {
        failures += shoal::test::replay(argv[i], count);
      } else {
        std::printf("%s: %s\n", argv[i], shoal::test::outcome_of(shoal::test::read_whole_file(argv[i])).c_str());
        ++count;
      }
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  std::printf("%d files, %d failures\n", count, failures);
  return failures == 0 && count > 0 ? 0 : 1;
}
