// What the command leaves behind: files that appear whole or not at all, and checked standard output.
#pragma once

#include <cstdio>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace shoal::app {

// A file written beside its place and renamed into it.
//
// Until commit() the old file, if there was one, is as it was; without commit() nothing is left. A signal that ends the
// program (interrupt, hang-up, terminate) removes what was begun, once remove_partial_outputs_on_signals() was called.
// A path that is there and is no regular file (a device, a pipe) is written to directly.
class OutputFile {
 public:
  // Opens; throws Error where that is not possible.
  explicit OutputFile(const std::string& path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  std::FILE* stream() { return stream_; }
  // Everything to the disk; throws Error where a byte of it could not be written. No writing afterwards.
  void finish();
  // Takes the old file's place. After finish().
  void commit();

 private:
  std::string path_;       // as the user wrote it, for messages
  std::string target_;     // links resolved
  std::string temporary_;  // empty: written directly
  int slot_ = -1;          // in the list of files that a signal removes
  std::FILE* stream_ = nullptr;
};

// A folder of files that take their places together, once all of them are on the disk.
//
// Until commit() files that were there before are as they were, and a folder that was not there is gone at the end,
// also on a signal. Other files in the folder stay.
class OutputFolder {
 public:
  // Makes the folder where there is none; throws Error where that, or a file in it, is not possible.
  explicit OutputFolder(const std::string& path);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  // A file of it, to the disk now.
  void add(const std::string& name, const std::function<void(std::FILE*)>& write);
  void add(const std::string& name, std::string_view bytes);
  // In the order in which they were added.
  void commit();

  std::string file_path(const std::string& name) const;

 private:
  void discard();

  std::string path_;
  bool made_ = false;  // by us, and not yet to stay
  int slot_ = -1;      // in the list of what a signal removes
  std::vector<std::unique_ptr<OutputFile>> files_;
};

// Throws Error where `path` could not be written now, and leaves nothing: a long render finds that out before it
// starts.
void check_writable(const std::string& path);

// Writes a whole text to a file, or to standard output where `path` is "-".
void write_text(const std::string& path, std::string_view text);

// Throws Error where standard output is closed or full.
void write_stdout(std::string_view text);

// Also lets writes beyond a file size limit or into a closed pipe fail as errors, in one line.
void remove_partial_outputs_on_signals();

}  // namespace shoal::app
