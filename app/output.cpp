#include "app/output.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstdlib>
#include <cstring>

#include "core/error.h"

namespace shoal::app {
namespace {

// Temporary files in being, where a signal handler finds them: nothing here is allocated.
struct TemporarySlot {
  std::atomic<bool> in_use{false};
  char path[PATH_MAX] = {};
};
constexpr int kSlots = 256;
TemporarySlot slots[kSlots];

int remember_temporary(const std::string& path) {
  if (path.size() >= PATH_MAX) return -1;
  for (int i = 0; i < kSlots; ++i) {
    if (slots[i].in_use.load()) continue;
    std::memcpy(slots[i].path, path.c_str(), path.size() + 1);
    slots[i].in_use.store(true);
    return i;
  }
  return -1;
}

void forget_temporary(int& slot) {
  if (slot >= 0) slots[slot].in_use.store(false);
  slot = -1;
}

extern "C" void remove_temporaries_and_die(int signal_number) {
  for (TemporarySlot& slot : slots) {
    if (slot.in_use.load()) unlink(slot.path);
  }
  // A folder, once it is empty.
  for (TemporarySlot& slot : slots) {
    if (slot.in_use.load()) rmdir(slot.path);
  }
  std::signal(signal_number, SIG_DFL);
  std::raise(signal_number);
}

//   error  errno, or 0 where it is not known any more: the stream remembers only that a write failed
[[noreturn]] void fail(const std::string& path, int error) {
  throw Error(fmt::format("{}: cannot be written ({}); expected a writable file", path,
                          error ? std::strerror(error) : "a write failed, the disk may be full"));
}

std::string directory_of(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  if (slash == std::string::npos) return "";
  return path.substr(0, slash + 1);
}

// Returns the file that `path` stands for once links are followed. A link whose target does not exist yet stands for
// that target, so that the link stays; a path that is no link stands for itself.
std::string resolve_links(const std::string& path) {
  char resolved[PATH_MAX];
  if (realpath(path.c_str(), resolved)) return resolved;
  constexpr int kMaxLinks = 40;  // as many as Linux follows
  std::string target = path;
  for (int i = 0; i < kMaxLinks; ++i) {
    const ssize_t length = readlink(target.c_str(), resolved, sizeof resolved);
    if (length < 0 || static_cast<std::size_t>(length) == sizeof resolved) return target;
    const std::string next(resolved, static_cast<std::size_t>(length));
    target = next.starts_with('/') ? next : directory_of(target) + next;
  }
  return path;
}

struct OpenTemporary {
  std::string path;
  int descriptor = -1;
};

OpenTemporary open_temporary(const std::string& target) {
  static std::atomic<unsigned> counter{0};
  for (int attempt = 0; attempt < 100; ++attempt) {
    OpenTemporary temporary;
    temporary.path = fmt::format("{}.shoal-{}-{}.tmp", directory_of(target), getpid(), counter.fetch_add(1));
    temporary.descriptor = open(temporary.path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (temporary.descriptor >= 0 || errno != EEXIST) return temporary;
  }
  return {};
}

}  // namespace

OutputFile::OutputFile(const std::string& path) : path_(path), target_(resolve_links(path)) {
  struct stat status {};
  const bool exists = stat(target_.c_str(), &status) == 0;
  if (exists && S_ISDIR(status.st_mode)) fail(path_, EISDIR);
  int descriptor = -1;
  if (exists && !S_ISREG(status.st_mode)) {
    descriptor = open(target_.c_str(), O_WRONLY | O_CLOEXEC);
  } else if (exists && access(target_.c_str(), W_OK) != 0) {
    fail(path_, errno);
  } else {
    const OpenTemporary temporary = open_temporary(target_);
    descriptor = temporary.descriptor;
    if (descriptor >= 0) {
      temporary_ = temporary.path;
      slot_ = remember_temporary(temporary_);
    }
  }
  if (descriptor < 0) fail(path_, errno);
  stream_ = fdopen(descriptor, "wb");
  if (!stream_) {
    const int error = errno;
    close(descriptor);
    if (!temporary_.empty()) unlink(temporary_.c_str());
    forget_temporary(slot_);
    fail(path_, error);
  }
}

OutputFile::~OutputFile() {
  if (stream_) std::fclose(stream_);
  if (!temporary_.empty()) unlink(temporary_.c_str());
  forget_temporary(slot_);
}

void OutputFile::finish() {
  errno = 0;
  bool written = !std::ferror(stream_) && std::fflush(stream_) == 0;
  int error = errno;
  if (written && !temporary_.empty() && fsync(fileno(stream_)) != 0) {
    written = false;
    error = errno;
  }
  const bool closed = std::fclose(stream_) == 0;
  if (written && !closed) error = errno;
  stream_ = nullptr;
  if (!written || !closed) fail(path_, error);
}

void OutputFile::commit() {
  if (temporary_.empty()) return;
  if (std::rename(temporary_.c_str(), target_.c_str()) != 0) fail(path_, errno);
  temporary_.clear();
  forget_temporary(slot_);
}

OutputFolder::OutputFolder(const std::string& path) : path_(path) {
  struct stat status {};
  if (stat(path_.c_str(), &status) == 0) {
    if (!S_ISDIR(status.st_mode)) {
      throw Error(fmt::format("{}: cannot be written (is a file); expected a folder, or a name for one", path_));
    }
  } else {
    if (mkdir(path_.c_str(), 0777) != 0) {
      throw Error(
          fmt::format("{}: cannot be made ({}); expected a writable folder around it", path_, std::strerror(errno)));
    }
    made_ = true;
    slot_ = remember_temporary(path_);
  }
  try {
    check_writable(file_path("report.html"));
  } catch (...) {
    discard();
    throw;
  }
}

OutputFolder::~OutputFolder() {
  files_.clear();
  discard();
}

void OutputFolder::discard() {
  if (made_) rmdir(path_.c_str());
  made_ = false;
  forget_temporary(slot_);
}

std::string OutputFolder::file_path(const std::string& name) const {
  return path_ + (path_.ends_with('/') ? "" : "/") + name;
}

void OutputFolder::add(const std::string& name, const std::function<void(std::FILE*)>& write) {
  auto file = std::make_unique<OutputFile>(file_path(name));
  write(file->stream());
  file->finish();
  files_.push_back(std::move(file));
}

void OutputFolder::add(const std::string& name, std::string_view bytes) {
  add(name, [&](std::FILE* stream) { std::fwrite(bytes.data(), 1, bytes.size(), stream); });
}

void OutputFolder::commit() {
  for (const auto& file : files_) file->commit();
  made_ = false;
  forget_temporary(slot_);
}

void check_writable(const std::string& path) {
  struct stat status {};
  const bool exists = stat(path.c_str(), &status) == 0;
  // Opening a pipe just to look would end it for its reader.
  if (exists && !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode)) return;
  const OutputFile trial(path);
}

void write_text(const std::string& path, std::string_view text) {
  if (path == "-") {
    write_stdout(text);
    return;
  }
  OutputFile file(path);
  std::fwrite(text.data(), 1, text.size(), file.stream());
  file.finish();
  file.commit();
}

void write_stdout(std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = write(STDOUT_FILENO, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) {
      throw Error(
          fmt::format("standard output: cannot be written ({}); expected somewhere to write to", std::strerror(errno)));
    }
    text.remove_prefix(static_cast<std::size_t>(written));
  }
}

void remove_partial_outputs_on_signals() {
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction old {};
    // One that the caller has switched off (nohup, a background job) stays off.
    if (sigaction(number, nullptr, &old) == 0 && old.sa_handler == SIG_IGN) continue;
    struct sigaction action {};
    action.sa_handler = remove_temporaries_and_die;
    sigemptyset(&action.sa_mask);
    sigaction(number, &action, nullptr);
  }
  std::signal(SIGXFSZ, SIG_IGN);
  std::signal(SIGPIPE, SIG_IGN);
}

}  // namespace shoal::app
