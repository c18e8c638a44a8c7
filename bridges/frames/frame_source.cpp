#include "bridges/frames/frame_source.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <poll.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>
#include <vector>

#include "bridges/frames/frame_parser.hpp"
#include "bridges/frames/picture_file.hpp"
#include "hal/monotonic.hpp"
#include "hal/program.hpp"
#include "hal/unit.hpp"

namespace tandem::bridges::frames {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kReadAtOnce = std::size_t{1} << 18U;
constexpr hal::TimeNs kAgain_ns = 2 * hal::kNsPerSecond;  // a camera that went is asked for this often
constexpr double kPictures_hz = 15.0;

using hal::monotonic_ns;

void sleep_ms(int ms) noexcept {
  const timespec pause{ms / 1000, static_cast<long>(ms % 1000) * 1'000'000};
  ::nanosleep(&pause, nullptr);
}

/// Frames in bytes that a descriptor gives.
class Stream {
 public:
  enum class Read { Frame, Nothing, End };
  Stream() : buffer_(kReadAtOnce) {}

  Read next(int descriptor, Frame& frame, int timeout_ms) {
    if (parser_.next(frame)) return got(frame);
    const hal::TimeNs end_ns = monotonic_ns() + timeout_ms * hal::kNsPerMs;
    for (;;) {
      const hal::TimeNs left_ns = end_ns - monotonic_ns();
      pollfd waits{descriptor, POLLIN, 0};
      const int ready = ::poll(&waits, 1, static_cast<int>(std::max<hal::TimeNs>(0, left_ns / hal::kNsPerMs)));
      if (ready <= 0) return Read::Nothing;
      const ssize_t size = ::read(descriptor, buffer_.data(), buffer_.size());
      if (size < 0 && (errno == EAGAIN || errno == EINTR)) return Read::Nothing;
      if (size <= 0) return Read::End;
      parser_.add(std::span(buffer_).first(static_cast<std::size_t>(size)));
      if (parser_.next(frame)) return got(frame);
      if (left_ns <= 0) return Read::Nothing;
    }
  }
  void begin_again() { parser_.reset(); }
  std::uint64_t malformed() const noexcept { return parser_.malformed(); }
  const std::string& trouble() const noexcept { return parser_.trouble(); }

 private:
  static Read got(Frame& frame) {
    frame.received_ns = monotonic_ns();
    return Read::Frame;
  }
  FrameParser parser_;
  std::vector<std::byte> buffer_;
};

/// A named pipe, whose writers come and go, or an ordinary file.
class PipeSource final : public FrameSource {
 public:
  PipeSource(std::string path, int descriptor, bool is_pipe)
      : path_(std::move(path)), descriptor_(descriptor), is_pipe_(is_pipe) {}
  ~PipeSource() override {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  static hal::Result<std::unique_ptr<FrameSource>> open(const std::string& path) {
    std::error_code error;
    if (!fs::exists(path, error) && ::mkfifo(path.c_str(), 0600) != 0)
      return hal::Error{"the pipe '" + path + "' cannot be made: " + std::strerror(errno)};
    const int descriptor = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (descriptor < 0) return hal::Error{"'" + path + "' cannot be read: " + std::strerror(errno)};
    struct stat s {};
    const bool is_pipe = ::fstat(descriptor, &s) == 0 && S_ISFIFO(s.st_mode);
    if (is_pipe) (void)::fcntl(descriptor, F_SETPIPE_SZ, 1 << 20);
    return std::unique_ptr<FrameSource>(std::make_unique<PipeSource>(path, descriptor, is_pipe));
  }
  Got next(Frame& frame, int timeout_ms) override {
    if (descriptor_ < 0 && !open_again()) {
      sleep_ms(timeout_ms);
      return Got::Nothing;
    }
    const auto read = stream_.next(descriptor_, frame, timeout_ms);
    if (read == Stream::Read::Frame) return Got::Frame;
    if (read == Stream::Read::Nothing) return Got::Nothing;
    if (!is_pipe_) return Got::Over;
    // Its writer has gone; a pipe that is opened anew waits for another one.
    ::close(descriptor_);
    (void)open_again();
    stream_.begin_again();
    return Got::Nothing;
  }
  std::uint64_t malformed() const override { return stream_.malformed(); }
  std::string trouble() const override { return stream_.trouble(); }

 private:
  bool open_again() noexcept {
    descriptor_ = ::open(path_.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    return descriptor_ >= 0;
  }

  std::string path_;
  int descriptor_;
  bool is_pipe_;
  Stream stream_;
};

/// What ffmpeg makes of a film or a camera. A camera that goes is asked for again.
class FfmpegSource final : public FrameSource {
 public:
  FfmpegSource(std::vector<std::string> arguments, bool again) : arguments_(std::move(arguments)), again_(again) {}
  Got next(Frame& frame, int timeout_ms) override {
    if (program_ == nullptr && !start(timeout_ms)) return over_ ? Got::Over : Got::Nothing;
    const auto read = stream_.next(program_->output(), frame, timeout_ms);
    if (read == Stream::Read::Frame) trouble_.clear();
    if (read == Stream::Read::Frame) return Got::Frame;
    if (read == Stream::Read::Nothing) return Got::Nothing;
    const hal::Status ended = program_->finish();
    if (!ended.ok()) trouble_ = ended.error().message;
    if (ended.ok() && again_) trouble_ = "the camera sends nothing more";
    program_.reset();
    stream_.begin_again();
    over_ = !again_;
    next_start_ns_ = monotonic_ns() + kAgain_ns;
    return over_ ? Got::Over : Got::Nothing;
  }
  std::uint64_t malformed() const override { return stream_.malformed(); }
  std::string trouble() const override { return trouble_.empty() ? stream_.trouble() : trouble_; }

 private:
  bool start(int timeout_ms) {
    if (over_) return false;
    if (monotonic_ns() < next_start_ns_) {
      sleep_ms(timeout_ms);
      return false;
    }
    next_start_ns_ = monotonic_ns() + kAgain_ns;
    auto started = hal::Program::start_source(hal::find_program("ffmpeg"), arguments_);
    if (!started.ok()) {
      trouble_ = started.error().message;
      over_ = !again_;
      return false;
    }
    program_ = std::move(started).value();
    return true;
  }

  std::vector<std::string> arguments_;
  bool again_, over_ = false;
  hal::TimeNs next_start_ns_ = 0;
  std::unique_ptr<hal::Program> program_;
  Stream stream_;
  std::string trouble_;
};

class FolderSource final : public FrameSource {
 public:
  FolderSource(std::vector<std::string> paths, hal::TimeNs period_ns)
      : paths_(std::move(paths)), period_ns_(period_ns) {}
  Got next(Frame& frame, int timeout_ms) override {
    if (next_ == paths_.size()) return Got::Over;
    if (period_ns_ > 0) {
      const hal::TimeNs now = monotonic_ns();
      if (due_ns_ == 0) due_ns_ = now;
      const hal::TimeNs wait_ns = due_ns_ - now;
      sleep_ms(static_cast<int>(std::clamp<hal::TimeNs>(wait_ns / hal::kNsPerMs, 0, timeout_ms)));
      if (wait_ns > timeout_ms * hal::kNsPerMs) return Got::Nothing;
      due_ns_ += period_ns_;
    }
    auto read = read_picture(paths_[next_++]);
    if (!read.ok()) {
      ++malformed_;
      trouble_ = read.error().message;
      return Got::Nothing;
    }
    frame = std::move(read).value();
    frame.received_ns = monotonic_ns();
    return Got::Frame;
  }
  std::uint64_t malformed() const override { return malformed_; }
  std::string trouble() const override { return trouble_; }

 private:
  std::vector<std::string> paths_;
  hal::TimeNs period_ns_;
  hal::TimeNs due_ns_ = 0;
  std::size_t next_ = 0;
  std::uint64_t malformed_ = 0;
  std::string trouble_;
};

std::vector<std::string> pictures_in(const std::string& folder) {
  std::vector<std::string> paths;
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    const std::string ending = at->path().extension().string();
    if (ending == ".png" || ending == ".pgm") paths.push_back(at->path().string());
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

struct What {
  std::string kind, path;
};

hal::Result<What> split(const std::string& what) {
  static constexpr std::array<std::string_view, 4> kKinds = {"camera", "film", "folder", "pipe"};
  const std::size_t colon = what.find(':');
  const std::string kind = what.substr(0, colon);
  if (colon == std::string::npos || colon + 1 == what.size() ||
      std::find(kKinds.begin(), kKinds.end(), kind) == kKinds.end())
    return hal::Error{"frames '" + what +
                      "' are none; write camera:/dev/video0, film:FILE, folder:FOLDER (of PNG or PGM) or pipe:FILE"};
  return What{kind, what.substr(colon + 1)};
}

/// Only what is seen when nobody has opened anything yet.
hal::Result<What> sound(const std::string& text) {
  auto what = split(text);
  if (!what.ok()) return what;
  const auto& [kind, path] = what.value();
  std::error_code error;
  if ((kind == "film" || kind == "camera") && hal::find_program("ffmpeg").empty())
    return hal::Error{"frames of a " + kind +
                      " are read by ffmpeg, which is not installed: sudo apt-get install ffmpeg"};
  if (kind == "film" && !fs::is_regular_file(path, error)) return hal::Error{"there is no film '" + path + "'"};
  if (kind == "folder" && pictures_in(path).empty())
    return hal::Error{"the folder '" + path + "' has no pictures (.png, .pgm)"};
  if (kind == "pipe" && fs::is_directory(path, error))
    return hal::Error{"'" + path + "' is a folder; write folder:" + path};
  return what;
}

std::vector<std::string> arguments_of(const What& what, const SourceOptions& options) {
  std::vector<std::string> words = {"-hide_banner", "-loglevel", "error", "-nostats", "-nostdin"};
  const auto add = [&](std::initializer_list<std::string> more) { words.insert(words.end(), more); };
  if (what.kind == "camera") {
    add({"-f", "v4l2", "-fflags", "nobuffer"});
    if (options.rate_hz > 0.0) add({"-framerate", hal::format_number(options.rate_hz)});
    if (options.width > 0) add({"-video_size", std::to_string(options.width) + "x" + std::to_string(options.height)});
  } else if (options.live) {
    add({"-re"});
  }
  add({"-i", what.kind == "film" ? "file:" + what.path : what.path, "-an", "-pix_fmt", "gray", "-f", "yuv4mpegpipe",
       "-strict", "-1", "pipe:1"});
  return words;
}

}  // namespace

hal::Result<std::unique_ptr<FrameSource>> open_frames(const std::string& text, const SourceOptions& options) {
  const auto what = sound(text);
  if (!what.ok()) return what.error();
  const auto& [kind, path] = what.value();
  if (kind == "pipe") return PipeSource::open(path);
  if (kind == "folder") {
    const double rate_hz = options.rate_hz > 0.0 ? options.rate_hz : kPictures_hz;
    return std::unique_ptr<FrameSource>(
        std::make_unique<FolderSource>(pictures_in(path), options.live ? static_cast<hal::TimeNs>(1e9 / rate_hz) : 0));
  }
  return std::unique_ptr<FrameSource>(
      std::make_unique<FfmpegSource>(arguments_of(what.value(), options), kind == "camera"));
}

hal::Status check_frames(const std::string& text) {
  const auto what = sound(text);
  return what.ok() ? hal::Status{} : what.error();
}

}  // namespace tandem::bridges::frames
