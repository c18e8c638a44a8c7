// The log: LOG and LOGERR, of robots RLOG and RLOGERR. All lines go to Tandem's log, a robot's ones under its id.
#ifndef TANDEM_ARGOS3_LOG_H
#define TANDEM_ARGOS3_LOG_H
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <string>

#include <argos3/core/config.h>
#include <argos3/core/utility/datatypes/datatypes.h>
#include <argos3/core/utility/logging/argos_colored_text.h>

namespace argos {

/// A stream whose text is kept per thread and told line by line. Also a std::ostream, for functions that want one.
class CARGoSLog : public std::ostream {
 public:
  explicit CARGoSLog(bool error);
  ~CARGoSLog();
  CARGoSLog(const CARGoSLog&) = delete;
  CARGoSLog& operator=(const CARGoSLog&) = delete;

  // The log has no colours.
  void EnableColoredOutput() {}
  void DisableColoredOutput() {}
  bool IsColoredOutput() const { return false; }
  /// Of this thread.
  std::ostream& GetStream();
  /// Also appends what comes to a file.
  void RedirectToFile(const std::string& file);
  /// Tells what is there, a line that has not ended too.
  void Flush();
  void AddThreadSafeBuffer() {}

  // The format is this thread's, as with manipulators.
  std::streamsize precision() { return GetStream().precision(); }
  std::streamsize precision(std::streamsize digits) { return GetStream().precision(digits); }
  std::streamsize width() { return GetStream().width(); }
  std::streamsize width(std::streamsize least) { return GetStream().width(least); }
  char fill() { return GetStream().fill(); }
  char fill(char with) { return GetStream().fill(with); }
  fmtflags flags() { return GetStream().flags(); }
  fmtflags flags(fmtflags flags) { return GetStream().flags(flags); }
  fmtflags setf(fmtflags flags) { return GetStream().setf(flags); }
  fmtflags setf(fmtflags flags, fmtflags mask) { return GetStream().setf(flags, mask); }
  void unsetf(fmtflags flags) { GetStream().unsetf(flags); }

  template <typename T>
  CARGoSLog& operator<<(const T& value) {
    GetStream() << value;
    return *this;
  }
  CARGoSLog& operator<<(std::ostream& (*manipulator)(std::ostream&));
  CARGoSLog& operator<<(std::ios_base& (*manipulator)(std::ios_base&)) {
    manipulator(GetStream());
    return *this;
  }

 private:
  const bool m_bError;
};

extern CARGoSLog LOG;
extern CARGoSLog LOGERR;
extern size_t DEBUG_INDENTATION;

}  // namespace argos

#define RLOG ::argos::LOG << "[" << GetId() << "] "
#define RLOGERR ::argos::LOGERR << "[" << GetId() << "] "

#define DEBUG(...)                                                                                                \
  {                                                                                                               \
    ::std::fprintf(stderr, "[DEBUG] %*s", static_cast<int>(2 * ::argos::DEBUG_INDENTATION), "");                  \
    ::std::fprintf(stderr, __VA_ARGS__);                                                                          \
  }
#define DEBUG_FUNCTION_ENTER                      \
  {                                               \
    ++::argos::DEBUG_INDENTATION;                 \
    DEBUG("%s - START\n", __PRETTY_FUNCTION__)    \
  }
#define DEBUG_FUNCTION_EXIT                       \
  {                                               \
    DEBUG("%s - END\n", __PRETTY_FUNCTION__)      \
    --::argos::DEBUG_INDENTATION;                 \
  }
#define TRACE(LINE) \
  LINE;             \
  DEBUG(#LINE "\n");

#endif
