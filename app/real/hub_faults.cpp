#include "app/real/hub_faults.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <ctime>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include "bridges/emulation/fault_table.hpp"

namespace tandem::app {
namespace {

using hal::TimeNs;

// In the order of HubFaultKind.
constexpr std::array<bridges::FaultForm, 4> kForms = {{
    {"stall", bridges::FaultValue::None, true, bridges::kEndless, "stall@5s+0.4s",
     "the loop waits; the threads that talk with the robots go on"},
    {"freeze", bridges::FaultValue::None, true, bridges::kEndless, "freeze@5s+2s",
     "the whole program sleeps (SIGSTOP), and goes on"},
    {"kill", bridges::FaultValue::None, true, 0, "kill@5s", "the program is killed (SIGKILL)"},
    {"clock", bridges::FaultValue::Jump, true, 0, "clock=1h@5s",
     "the program's clock that shows the date jumps, by -1h backwards"},
}};

// The clock is asked for by threads of links.
std::atomic<TimeNs> clock_jump_ns{0};

hal::Error wrong(const std::string& text, const std::string& why) {
  return hal::Error{"hub fault '" + text + "': " + why + ". The faults are\n" + hub_fault_manual()};
}

void sleep_for(TimeNs duration) noexcept {
  timespec left{static_cast<time_t>(duration / hal::kNsPerSecond), static_cast<long>(duration % hal::kNsPerSecond)};
  while (::nanosleep(&left, &left) != 0 && errno == EINTR) {
  }
}

/// A child stops this process and has it go on. Only calls that are safe after a fork of a program with threads.
void freeze(TimeNs duration) {
  const pid_t self = ::getpid();
  const pid_t child = ::fork();
  if (child < 0) return;
  if (child == 0) {
    ::syscall(SYS_close_range, 0U, ~0U, 0U);
    ::kill(self, SIGSTOP);
    sleep_for(duration);
    ::kill(self, SIGCONT);
    ::_exit(0);
  }
  while (::waitpid(child, nullptr, 0) < 0 && errno == EINTR) {
  }
}

void act(const HubFault& fault) {
  switch (fault.kind) {
    case HubFaultKind::Stall:
      sleep_for(fault.lasts);
      break;
    case HubFaultKind::Freeze:
      freeze(fault.lasts);
      break;
    case HubFaultKind::Kill:
      ::kill(::getpid(), SIGKILL);
      break;
    case HubFaultKind::Clock:
      clock_jump_ns.fetch_add(fault.jump_ns, std::memory_order_relaxed);
      break;
  }
}

}  // namespace

std::string hub_fault_manual() {
  return bridges::manual_of_faults(kForms) + "Times count from the start of the run.";
}

hal::Result<HubFault> parse_hub_fault(const std::string& text) {
  bridges::ReadFault read;
  const auto row = bridges::read_fault(text, kForms, read);
  if (!row.ok()) return wrong(text, row.error().message);
  const std::string name(kForms[row.value()].name), example = ", as in " + std::string(kForms[row.value()].example);
  if (read.since_drive) return wrong(text, "a hub knows no @drive" + example);
  if (read.moment && read.until > read.from) return wrong(text, "'" + name + "' takes no duration");
  if (!read.moment && read.until == bridges::kEndless) return wrong(text, "say for how long" + example);
  return HubFault{static_cast<HubFaultKind>(row.value()), read.from, read.until - read.from, read.time_ns};
}

hal::Result<HubFaults> HubFaults::make(const std::vector<std::string>& texts) {
  HubFaults all;
  for (const std::string& text : texts) {
    const auto fault = parse_hub_fault(text);
    if (!fault.ok()) return fault.error();
    all.faults_.push_back(fault.value());
  }
  std::stable_sort(all.faults_.begin(), all.faults_.end(),
                   [](const HubFault& a, const HubFault& b) { return a.from > b.from; });
  return all;
}

void HubFaults::apply(TimeNs now) {
  if (!started_) start_ns_ = now;
  started_ = true;
  while (!faults_.empty() && now - start_ns_ >= faults_.back().from) {
    const HubFault fault = faults_.back();
    faults_.pop_back();
    act(fault);
  }
}

TimeNs hub_unix_ns() noexcept {
  timespec t{};
  ::clock_gettime(CLOCK_REALTIME, &t);
  return static_cast<TimeNs>(t.tv_sec) * hal::kNsPerSecond + t.tv_nsec + clock_jump_ns.load(std::memory_order_relaxed);
}

}  // namespace tandem::app
