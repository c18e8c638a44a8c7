#include "bridges/tracker_emulator/frame_sender.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

namespace tandem::bridges::tracker_emulator {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kHeader = 24;
constexpr int kPatience_ms = 1000;  // with a reader who does not read

void put(std::vector<std::byte>& bytes, std::uint64_t value, int count) {
  for (int i = 0; i < count; ++i) bytes.push_back(static_cast<std::byte>(value >> (8 * i) & 0xFFU));
}

std::size_t number(const std::vector<std::byte>& bytes, std::size_t at) {
  std::size_t value = 0;
  for (std::size_t i = 4; i-- > 0;) value = value << 8U | std::to_integer<std::size_t>(bytes[at + i]);
  return value;
}

class PipeSender final : public Sender {
 public:
  explicit PipeSender(std::string path) : path_(std::move(path)) {}
  ~PipeSender() override { hang_up(); }
  void send(const std::vector<std::byte>& message) override {
    if (pipe_ < 0) pipe_ = ::open(path_.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC);
    if (pipe_ < 0) return;  // nobody reads
    (void)::fcntl(pipe_, F_SETPIPE_SZ, 1 << 20);
    for (std::size_t at = 0; at < message.size();) {
      const ssize_t n = ::write(pipe_, message.data() + at, message.size() - at);
      if (n > 0) at += static_cast<std::size_t>(n);
      if (n > 0 || (n < 0 && errno == EINTR)) continue;
      pollfd ready{pipe_, POLLOUT, 0};
      if (n >= 0 || errno != EAGAIN || ::poll(&ready, 1, kPatience_ms) <= 0) return hang_up();
    }
  }

 private:
  void hang_up() {
    if (pipe_ >= 0) ::close(pipe_);
    pipe_ = -1;
  }
  std::string path_;
  int pipe_ = -1;
};

class FolderSender final : public Sender {
 public:
  explicit FolderSender(std::string folder) : folder_(std::move(folder)) {}
  void send(const std::vector<std::byte>& message) override {
    if (message.size() < kHeader) return;
    char name[32];
    std::snprintf(name, sizeof name, "%06lld.pgm", static_cast<long long>(frames_++));
    const fs::path path = fs::path(folder_) / name;
    {
      std::ofstream out(path.string() + ".part", std::ios::binary);
      out << "P5\n" << number(message, 4) << " " << number(message, 8) << "\n255\n";
      out.write(reinterpret_cast<const char*>(message.data() + kHeader),
                static_cast<std::streamsize>(message.size() - kHeader));
    }
    std::error_code error;
    fs::rename(path.string() + ".part", path, error);
  }

 private:
  std::string folder_;
  std::int64_t frames_ = 0;
};

}  // namespace

bool sends_frames(const std::string& link) noexcept {
  return link.starts_with("pipe:") || link.starts_with("folder:");
}

hal::Result<std::unique_ptr<Sender>> open_frame_sender(const std::string& link) {
  const std::string path = link.substr(link.find(':') + 1);
  std::error_code error;
  if (link.starts_with("folder:")) {
    fs::create_directories(path, error);
    if (error) return hal::Error{"the folder '" + path + "' cannot be made: " + error.message()};
    return std::unique_ptr<Sender>(std::make_unique<FolderSender>(path));
  }
  if (!fs::exists(path, error) && ::mkfifo(path.c_str(), 0600) != 0)
    return hal::Error{"the pipe '" + path + "' cannot be made: " + std::strerror(errno)};
  return std::unique_ptr<Sender>(std::make_unique<PipeSender>(path));
}

std::vector<std::byte> frame_message(std::size_t width, std::size_t height, std::int64_t stamp_ns,
                                     const std::vector<std::uint8_t>& grey) {
  std::vector<std::byte> bytes;
  bytes.reserve(kHeader + grey.size());
  for (const char c : {'T', 'D', 'F', '1'}) bytes.push_back(static_cast<std::byte>(c));
  put(bytes, width, 4);
  put(bytes, height, 4);
  put(bytes, 0, 4);
  put(bytes, static_cast<std::uint64_t>(stamp_ns), 8);
  const auto* const first = reinterpret_cast<const std::byte*>(grey.data());
  bytes.insert(bytes.end(), first, first + grey.size());
  return bytes;
}

}  // namespace tandem::bridges::tracker_emulator
