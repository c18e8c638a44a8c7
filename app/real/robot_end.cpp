#include "app/real/robot_end.hpp"

#include <cstdio>

#include "app/build_info.hpp"
#include "app/exit_code.hpp"
#include "app/process/signals.hpp"
#include "app/process/terminal.hpp"

namespace tandem::app {

std::string RobotEnd::word() const {
  if (!failure.empty()) return "failed";
  return interrupted ? "interrupted" : how;
}

hal::Result<std::optional<hal::OutputFile>> open_report(const std::string& path) {
  if (path.empty()) return std::optional<hal::OutputFile>();
  auto opened = hal::OutputFile::open(path, "report");
  if (!opened.ok()) return opened.error();
  return std::optional<hal::OutputFile>(std::move(opened).value());
}

int end_robot(std::optional<hal::OutputFile>& report, hal::Json json, const RobotEnd& end) {
  if (report) {
    json["program"] = to_json(build_info());
    json["finished"] = end.failure.empty() && !end.interrupted;
    json["ended"] = end.word();
    if (!end.failure.empty()) json["failure"] = end.failure;
    std::fflush(stdout);
    hal::Status written = report->write(hal::to_text(json) + "\n");
    if (written.ok()) written = report->commit();
    if (!written.ok()) return complain(kFailedRunning, written.error().message);
  }
  if (!end.failure.empty()) return complain(kFailedRunning, end.failure);
  return end.interrupted ? interrupted_code() : kDone;
}

}  // namespace tandem::app
