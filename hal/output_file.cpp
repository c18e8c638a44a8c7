#include "hal/output_file.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>

namespace tandem::hal {
namespace {

namespace fs = std::filesystem;

Error cannot_write(std::string_view what, const std::string& path, const std::string& why) {
  return {"cannot write the " + std::string(what) + (path == "-" ? " to standard output" : " '" + path + "'") + ": " +
          why};
}

/// Where a link leads: the file behind it is replaced, not the link.
std::string behind_links(const std::string& path) {
  std::error_code error;
  if (!fs::is_symlink(fs::symlink_status(path, error))) return path;
  const fs::path target = fs::weakly_canonical(path, error);
  return error ? path : target.string();
}

/// Opens the part and locks it for as long as it is open. -1 and errno when that fails; EWOULDBLOCK: somebody else has
/// it.
int open_part(const std::string& part) {
  for (;;) {
    const int fd = open(part.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
    if (fd < 0) return -1;
    struct stat opened {};
    struct stat named {};
    int error = 0;
    if (flock(fd, LOCK_EX | LOCK_NB) != 0 && errno != ENOLCK && errno != EOPNOTSUPP) {
      error = errno;
    } else if (fstat(fd, &opened) == 0 && stat(part.c_str(), &named) == 0 && opened.st_ino == named.st_ino &&
               opened.st_dev == named.st_dev) {
      if (ftruncate(fd, 0) == 0) return fd;
      error = errno;
    }
    close(fd);
    if (error != 0) {
      errno = error;
      return -1;
    }
    // Its former writer has just renamed it: once more.
  }
}

}  // namespace

Result<OutputFile> OutputFile::open(const std::string& path, std::string_view what) {
  OutputFile file;
  file.path_ = path;
  file.what_ = what;
  if (path == "-") {
    file.fd_ = fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 3);
    if (file.fd_ < 0) return file.failed(errno);
    return file;
  }
  const std::string target = behind_links(path);
  struct stat old {};
  const bool there = stat(target.c_str(), &old) == 0;
  if (there && S_ISDIR(old.st_mode)) return cannot_write(what, path, "it is a folder");
  if (there && !S_ISREG(old.st_mode)) {
    file.fd_ = ::open(target.c_str(), O_WRONLY | O_CLOEXEC);
    if (file.fd_ < 0) return file.failed(errno);
    return file;
  }
  if (there && access(target.c_str(), W_OK) != 0) return file.failed(errno);
  const std::string part = target + ".part";
  file.fd_ = open_part(part);
  if (file.fd_ < 0) {
    if (errno == EWOULDBLOCK) return cannot_write(what, path, "another process is writing it (" + part + ")");
    return file.failed(errno);
  }
  if (there) (void)fchmod(file.fd_, old.st_mode & 07777);
  file.part_ = part;
  file.target_ = target;
  return file;
}

OutputFile::OutputFile(OutputFile&& other) noexcept {
  *this = std::move(other);
}

OutputFile& OutputFile::operator=(OutputFile&& other) noexcept {
  if (this == &other) return *this;
  abandon();
  path_ = std::move(other.path_);
  what_ = std::move(other.what_);
  part_ = std::move(other.part_);
  target_ = std::move(other.target_);
  fd_ = std::exchange(other.fd_, -1);
  keep_part_ = other.keep_part_;
  return *this;
}

OutputFile::~OutputFile() {
  abandon();
}

void OutputFile::abandon() noexcept {
  if (fd_ < 0) return;
  if (!part_.empty() && !keep_part_) unlink(part_.c_str());  // before the lock goes
  close(std::exchange(fd_, -1));
}

Error OutputFile::failed(int error) const {
  return cannot_write(what_, path_, std::strerror(error));
}

Status OutputFile::write(std::string_view text) {
  if (fd_ < 0) return failed(EBADF);
  std::size_t done = 0;
  while (done < text.size()) {
    const ssize_t n = ::write(fd_, text.data() + done, text.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n > 0) {
      done += static_cast<std::size_t>(n);
      continue;
    }
    const int error = n < 0 ? errno : EIO;
    const std::size_t line = text.substr(0, done).rfind('\n');
    const std::size_t whole = line == std::string_view::npos ? 0 : line + 1;
    const off_t end = part_.empty() ? -1 : lseek(fd_, 0, SEEK_CUR);
    if (end >= 0) (void)!ftruncate(fd_, end - static_cast<off_t>(done - whole));
    return failed(error);
  }
  return {};
}

Status OutputFile::commit() {
  if (fd_ < 0) return failed(EBADF);
  // The name goes first: after `close` the lock would be free, and another process could begin to write the part.
  const bool renamed = part_.empty() || std::rename(part_.c_str(), target_.c_str()) == 0;
  const int error = errno;
  if (!renamed) {
    abandon();
    return failed(error);
  }
  return close(std::exchange(fd_, -1)) == 0 || errno == EINTR ? Status{} : Status{failed(errno)};
}

Status write_whole_file(const std::string& path, std::string_view what, std::string_view text) {
  auto file = OutputFile::open(path, what);
  if (!file.ok()) return file.error();
  const Status written = file->write(text);
  return written.ok() ? file->commit() : written;
}

}  // namespace tandem::hal
