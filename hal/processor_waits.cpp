#include "hal/processor_waits.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>

namespace tandem::hal {

void ProcessorWaits::look(pid_t process) {
  std::error_code gone;
  for (const auto& thread : std::filesystem::directory_iterator("/proc/" + std::to_string(process) + "/task", gone)) {
    TimeNs ran_ns = 0, waited_ns = 0;
    std::ifstream account(thread.path() / "schedstat");
    if (!(account >> ran_ns >> waited_ns)) continue;
    const auto [known, is_new] = waited_ns_.try_emplace(thread.path().string(), waited_ns);
    longest_ns_ = std::max(longest_ns_, is_new ? waited_ns : waited_ns - known->second);
    known->second = waited_ns;
  }
}

}  // namespace tandem::hal
