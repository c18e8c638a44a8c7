#include "app/real/motion_memory.hpp"

#include <cstdio>
#include <ctime>
#include <fstream>
#include <unistd.h>

#include "app/process/terminal.hpp"
#include "bridges/guardian/robot_lock.hpp"
#include "hal/output_file.hpp"

namespace tandem::app {
namespace {

constexpr std::size_t kMostLines = 20, kLongest = 2000;  // that are read of a file

std::string date_text(std::int64_t unix_s) {
  const std::time_t at = static_cast<std::time_t>(unix_s);
  std::tm local{};
  char text[64] = "at an unknown time";
  if (::localtime_r(&at, &local) != nullptr) (void)std::strftime(text, sizeof text, "%Y-%m-%d %H:%M:%S", &local);
  return text;
}

}  // namespace

hal::Result<MotionMemory> MotionMemory::open() {
  auto folder = bridges::guardian::lock_folder();
  if (!folder.ok()) return folder.error();
  return MotionMemory(std::move(folder).value());
}

std::string MotionMemory::file_of(const bridges::StopMessages& robot) const {
  return folder_ + "/" + bridges::guardian::written_key(robot) + ".motion";
}

hal::Status MotionMemory::keep(const bridges::StopMessages& robot, const FailedMotion& failed) const {
  std::string text = "robot " + failed.robot + "\nat " + std::to_string(failed.unix_s) + "\n";
  for (std::string line : failed.found) {
    for (char& c : line) c = c == '\n' ? ' ' : c;
    text += line + "\n";
  }
  return hal::write_whole_file(file_of(robot), "failed first motion", text);
}

void MotionMemory::forget(const bridges::StopMessages& robot) const {
  (void)::unlink(file_of(robot).c_str());
}

std::optional<FailedMotion> MotionMemory::recall(const bridges::StopMessages& robot) const {
  std::ifstream file(file_of(robot));
  FailedMotion failed;
  std::string line;
  if (!std::getline(file, line) || !line.starts_with("robot ")) return {};
  failed.robot = line.substr(6);
  if (!std::getline(file, line) || !line.starts_with("at ")) return {};
  failed.unix_s = std::strtoll(line.c_str() + 3, nullptr, 10);
  while (failed.found.size() < kMostLines && std::getline(file, line)) failed.found.push_back(line.substr(0, kLongest));
  return failed;
}

hal::Status keep_motions(std::span<const bridges::StopMessages> robots, const mixed_reality::PreflightRows& rows) {
  using mixed_reality::Finding;
  const auto memory = MotionMemory::open();
  if (!memory.ok()) return {};  // whoever needs the locks says so
  hal::Status all;
  for (const bridges::StopMessages& robot : robots) {
    FailedMotion failed{robot.robot, static_cast<std::int64_t>(std::time(nullptr)), {}};
    bool right = false;
    for (const mixed_reality::PreflightRow& row : rows) {
      if (row.about != "robot " + robot.robot) continue;
      if (row.finding == Finding::Fail) failed.found.push_back(row.check + ": " + row.found);
      right = right || (row.check == "motion" && row.finding == Finding::Ok);
    }
    if (failed.found.empty() && right) memory.value().forget(robot);
    if (failed.found.empty()) continue;
    if (const hal::Status kept = memory.value().keep(robot, failed); !kept.ok()) all = kept;
  }
  return all;
}

hal::Status check_motions(std::span<const bridges::StopMessages> robots) {
  const auto memory = MotionMemory::open();
  if (!memory.ok()) return {};  // whoever needs the locks says so
  std::string text;
  for (const bridges::StopMessages& robot : robots) {
    const auto failed = memory.value().recall(robot);
    if (!failed) continue;
    text += "\n  robot '" + robot.robot + "' on " + robot.link + ", " + date_text(failed->unix_s) + ":";
    for (const std::string& found : failed->found) text += " " + printable(found) + ";";
    text.back() = '.';
  }
  if (text.empty()) return {};
  return hal::Error{"the last first motion (preflight --move) failed, and none was right since:" + text +
                    "\nMend that and try `tandem preflight FILE --move` again, or say --anyway"};
}

}  // namespace tandem::app
