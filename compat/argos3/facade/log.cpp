// LOG and LOGERR: text of a thread, handed to its context line by line.
#include <argos3/core/utility/logging/argos_log.h>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <sstream>
#include <streambuf>

#include "compat/argos3/facade/context.hpp"

namespace tandem::compat::argos3 {
namespace {

thread_local Context* context = nullptr;

/// Files that LOG and LOGERR are written to besides.
struct LogFile {
  std::mutex mutex;
  std::ofstream file;
};
std::array<LogFile, 2>& log_files() {
  static std::array<LogFile, 2> all;
  static const bool opened = [] {  // as the command `argos3 -l FILE -e FILE` wants it
    const std::array<const char*, 2> wanted = {std::getenv("TANDEM_ARGOS3_LOG"), std::getenv("TANDEM_ARGOS3_LOGERR")};
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (wanted[i] != nullptr) all[i].file.open(wanted[i], std::ios::app);
    }
    return true;
  }();
  (void)opened;
  return all;
}

void tell(bool error, std::string_view text) {
  LogFile& file = log_files()[error ? 1 : 0];
  {
    const std::lock_guard lock(file.mutex);
    if (file.file.is_open()) (file.file << text << '\n').flush();
  }
  if (context != nullptr)
    context->tell(error, text);
  else
    std::fprintf(error ? stderr : stdout, "%.*s\n", static_cast<int>(text.size()), text.data());
}

/// Text of one thread that has not been told. Whole lines are told when something is flushed or a line ends.
class Lines final : public std::streambuf {
 public:
  explicit Lines(bool error) : error_(error) {}
  /// Tells all that is there.
  void tell_rest() {
    if (!text_.empty()) tell_up_to(text_.size());
  }

 protected:
  int_type overflow(int_type c) override {
    if (c != traits_type::eof()) take({reinterpret_cast<const char*>(&c), 1});
    return 0;
  }
  std::streamsize xsputn(const char* text, std::streamsize count) override {
    take({text, static_cast<std::size_t>(count)});
    return count;
  }

 private:
  void take(std::string_view text) {
    const std::size_t end = text.rfind('\n');
    if (end == std::string_view::npos) {
      text_ += text;
      return;
    }
    text_ += text.substr(0, end);
    tell_up_to(text_.size());
    text_ = text.substr(end + 1);
  }
  void tell_up_to(std::size_t size) {
    const std::string told = std::exchange(text_, text_.substr(size)).substr(0, size);
    tell(error_, told);
  }

  const bool error_;
  std::string text_;
};

/// The stream that is written to in this thread.
struct OwnStream {
  explicit OwnStream(bool error) : lines(error), stream(&lines) {}
  Lines lines;
  std::ostream stream;
};
OwnStream& own_stream(bool error) {
  thread_local OwnStream out{false}, err{true};
  return error ? err : out;
}

/// What the std::ostream of LOG writes to: the thread's own text.
class Forward final : public std::streambuf {
 public:
  explicit Forward(bool error) : error_(error) {}

 protected:
  int_type overflow(int_type c) override {
    return c == traits_type::eof() ? 0 : own_stream(error_).lines.sputc(static_cast<char>(c));
  }
  std::streamsize xsputn(const char* text, std::streamsize count) override {
    return own_stream(error_).lines.sputn(text, count);
  }

 private:
  const bool error_;
};

}  // namespace

Context* current_context() noexcept {
  return context;
}

ContextScope::ContextScope(Context& inner) noexcept : outer_(std::exchange(context, &inner)) {}

ContextScope::~ContextScope() {
  own_stream(false).lines.tell_rest();
  own_stream(true).lines.tell_rest();
  context = outer_;
}

}  // namespace tandem::compat::argos3

namespace argos {

namespace compat = tandem::compat::argos3;

CARGoSLog LOG(false);
CARGoSLog LOGERR(true);
size_t DEBUG_INDENTATION = 0;

CARGoSLog::CARGoSLog(bool error) : std::ostream(nullptr), m_bError(error) {
  rdbuf(new compat::Forward(error));
}

CARGoSLog::~CARGoSLog() {
  delete rdbuf(nullptr);
}

std::ostream& CARGoSLog::GetStream() {
  return compat::own_stream(m_bError).stream;
}

void CARGoSLog::RedirectToFile(const std::string& file) {
  compat::LogFile& to = compat::log_files()[m_bError ? 1 : 0];
  const std::lock_guard lock(to.mutex);
  to.file = std::ofstream(file, std::ios::app);
}

void CARGoSLog::Flush() {
  compat::own_stream(m_bError).lines.tell_rest();
}

CARGoSLog& CARGoSLog::operator<<(std::ostream& (*manipulator)(std::ostream&)) {
  manipulator(GetStream());
  return *this;
}

}  // namespace argos
