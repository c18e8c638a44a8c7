#include "app/window/browser.hpp"

#include <cerrno>
#include <cstdlib>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "hal/program.hpp"

namespace tandem::app {

bool open_browser(const std::string& address) {
  const auto has = [](const char* name) {
    const char* const value = std::getenv(name);
    return value != nullptr && *value != '\0';
  };
  const std::string opener = hal::find_program("xdg-open");
  if ((!has("DISPLAY") && !has("WAYLAND_DISPLAY")) || opener.empty()) return false;
  // A shell in between starts it in the background: nobody has to wait for it, and what it prints goes nowhere.
  std::string words[] = {"sh", "-c", "\"$0\" \"$1\" </dev/null >/dev/null 2>&1 &", opener, address};
  char* arguments[] = {words[0].data(), words[1].data(), words[2].data(), words[3].data(), words[4].data(), nullptr};
  pid_t child = -1;
  if (::posix_spawn(&child, "/bin/sh", nullptr, nullptr, arguments, environ) != 0) return false;
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return true;
}

}  // namespace tandem::app
