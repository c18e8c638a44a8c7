// Log for messages of libraries to people. Passed in; nothing here prints by itself.
#pragma once
#include <functional>
#include <string>
#include <string_view>

namespace tandem::hal {

enum class Severity { Info, Warning, Error };

/// A sink for messages. Copyable; the default one drops everything. May be called from any thread when its sink allows
/// that.
class Log {
 public:
  using Sink = std::function<void(Severity, std::string_view)>;

  Log() = default;
  explicit Log(Sink sink) : sink_(std::move(sink)) {}

  bool drops_all() const noexcept { return !sink_; }
  void info(std::string_view text) const { write(Severity::Info, text); }
  void warning(std::string_view text) const { write(Severity::Warning, text); }
  void error(std::string_view text) const { write(Severity::Error, text); }
  void write(Severity severity, std::string_view text) const {
    if (sink_) sink_(severity, text);
  }

 private:
  Sink sink_;
};

}  // namespace tandem::hal
