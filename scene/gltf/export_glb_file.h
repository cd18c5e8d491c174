// A file that is written beside its place and then renamed, so that it appears whole or not at all.
#pragma once

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>

#include "core/error.h"

namespace shoal {

// The file is removed on destruction unless commit has renamed it.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& path) : path_(path), temporary_(path + ".tmp-" + std::to_string(getpid())) {
    const int descriptor = open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor < 0) fail();
    created_ = true;
    stream_ = fdopen(descriptor, "wb");
    if (stream_ == nullptr) {
      close(descriptor);
      unlink(temporary_.c_str());
      fail();
    }
  }
  ~TemporaryFile() {
    if (stream_ != nullptr) std::fclose(stream_);
    if (created_) unlink(temporary_.c_str());
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  std::FILE* stream() const { return stream_; }
  void commit() {
    const bool flushed = std::fflush(stream_) == 0 && fsync(fileno(stream_)) == 0;
    const int error = errno;
    const bool closed = std::fclose(stream_) == 0;
    stream_ = nullptr;
    if (!flushed) errno = error;
    if (!flushed || !closed || std::rename(temporary_.c_str(), path_.c_str()) != 0) fail();
    created_ = false;
  }

 private:
  [[noreturn]] void fail() const {
    throw Error(path_ + ": cannot be written (" + std::strerror(errno) + "); expected a writable file and room for it");
  }
  std::string path_, temporary_;
  bool created_ = false;
  std::FILE* stream_ = nullptr;
};

}  // namespace shoal
