#include "app/real/desk_keys.hpp"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <optional>
#include <unistd.h>

#include "bridges/guardian/robot_lock.hpp"
#include "hal/sha256.hpp"
#include "hal/token.hpp"

namespace tandem::app {
namespace {

using bridges::desk::DeskKey;
using Keys = std::vector<DeskKey>;
namespace fs = std::filesystem;

/// The user's file of keys; empty: there is none.
std::string users_file() {
  const char* const config = std::getenv("XDG_CONFIG_HOME");
  const char* const home = std::getenv("HOME");
  fs::path folder;
  if (config != nullptr && *config != 0)
    folder = config;
  else if (home != nullptr && *home != 0)
    folder = fs::path(home) / ".config";
  else
    return {};
  const fs::path file = folder / "tandem" / "desk.keys";
  std::error_code error;
  return fs::exists(file, error) ? file.string() : std::string();
}

/// Nothing: no file of keys is given, nor has this user one.
std::optional<hal::Result<Keys>> keys_of_files(const std::string& file) {
  const std::string path = file.empty() ? users_file() : file;
  if (path.empty()) return {};
  return bridges::desk::read_keys(path);
}

hal::Result<std::string> own_file(const std::string& url, const std::string& channel) {
  const auto folder = bridges::guardian::lock_folder();
  if (!folder.ok()) return folder.error();
  constexpr std::size_t kDigits = 16;
  return folder.value() + "/desk-" + hal::sha256(url + "#" + channel).substr(0, kDigits) + ".keys";
}

/// Makes it, unless a run before has.
hal::Status make_own_file(const std::string& path) {
  const auto secret = hal::make_token();
  if (!secret.ok()) return secret.error();
  const int fd = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0600);
  if (fd < 0 && errno == EEXIST) return {};
  const std::string text = "* operator " + secret.value() + "\n";
  const bool written = fd >= 0 && ::write(fd, text.data(), text.size()) == static_cast<ssize_t>(text.size());
  const int error = errno;
  if (fd >= 0) ::close(fd);
  if (written) return {};
  (void)::unlink(path.c_str());
  return hal::Error{"the key '" + path + "' cannot be made: " + std::strerror(error)};
}

}  // namespace

hal::Result<Keys> keys_to_listen(const std::string& file, const std::string& url, const std::string& channel) {
  if (auto given = keys_of_files(file)) return *given;
  const auto own = own_file(url, channel);
  if (!own.ok()) return own.error();
  if (const hal::Status made = make_own_file(own.value()); !made.ok()) return made.error();
  return bridges::desk::read_keys(own.value());
}

hal::Result<DeskKey> key_to_ask(const std::string& file, const std::string& url, const std::string& channel,
                                const std::string& who) {
  auto given = keys_of_files(file);
  if (!given) {
    const auto own = own_file(url, channel);
    if (!own.ok()) return own.error();
    std::error_code error;
    if (!fs::exists(own.value(), error))
      return hal::Error{"no run of this user listens on '" + url + "' channel '" + channel +
                        "' on this machine; to command one elsewhere, give the keys that it has: --keys FILE"};
    given = bridges::desk::read_keys(own.value());
  }
  if (!given->ok()) return given->error();
  const DeskKey* const key = bridges::desk::key_of(given->value(), who);
  if (key == nullptr) return hal::Error{"the keys have none of '" + who + "'; --who says whose to use"};
  return *key;
}

}  // namespace tandem::app
