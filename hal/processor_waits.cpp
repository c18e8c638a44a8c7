#include "hal/processor_waits.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>

namespace tandem::hal {
namespace {

/// `use(name, what it waited)` for each thread that there is.
template <class Use>
void each_thread(pid_t process, Use&& use) {
  std::error_code gone;
  for (const auto& thread : std::filesystem::directory_iterator("/proc/" + std::to_string(process) + "/task", gone)) {
    TimeNs ran_ns = 0, waited_ns = 0;
    std::ifstream account(thread.path() / "schedstat");
    if (account >> ran_ns >> waited_ns) use(thread.path().string(), waited_ns);
  }
}

}  // namespace

void ProcessorWaits::begin(pid_t process) {
  each_thread(process, [this](const std::string& thread, TimeNs waited_ns) { waited_ns_[thread] = waited_ns; });
}

void ProcessorWaits::look(pid_t process) {
  each_thread(process, [this](const std::string& thread, TimeNs waited_ns) {
    TimeNs& known_ns = waited_ns_[thread];  // 0 of a new one
    longest_ns_ = std::max(longest_ns_, waited_ns - known_ns);
    known_ns = waited_ns;
  });
}

}  // namespace tandem::hal
