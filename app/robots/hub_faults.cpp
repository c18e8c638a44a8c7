#include "app/robots/hub_faults.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <ctime>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include "bridges/emulation/fault_spec.hpp"

namespace tandem::app {
namespace {

using hal::TimeNs;

struct Entry {
  HubFaultKind kind;
  std::string_view name;
  bool has_value;
  bool lasts;
  std::string_view example;
  std::string_view doc;
};

constexpr std::array<Entry, 4> kEntries = {{
    {HubFaultKind::Stall, "stall", false, true, "stall@5s+0.4s",
     "the loop waits; the threads that talk with the robots go on"},
    {HubFaultKind::Freeze, "freeze", false, true, "freeze@5s+2s", "the whole program sleeps (SIGSTOP), and goes on"},
    {HubFaultKind::Kill, "kill", false, false, "kill@5s", "the program is killed (SIGKILL)"},
    {HubFaultKind::Clock, "clock", true, false, "clock=1h@5s",
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
  std::string text;
  for (const Entry& e : kEntries) {
    std::string example = "  " + std::string(e.example);
    example.resize(std::max<std::size_t>(18, example.size() + 1), ' ');
    text += example + std::string(e.doc) + "\n";
  }
  return text + "Times count from the start of the run.";
}

hal::Result<HubFault> parse_hub_fault(const std::string& text) {
  const auto split = bridges::split_fault(text);
  if (!split.ok()) return wrong(text, split.error().message);
  const bridges::FaultSpec& spec = split.value();
  const std::string name(spec.name);
  const auto entry = std::find_if(kEntries.begin(), kEntries.end(), [&](const Entry& e) { return e.name == name; });
  if (entry == kEntries.end()) return wrong(text, "there is no fault '" + name + "'");
  const std::string example = ", as in " + std::string(entry->example);
  if (spec.value.has_value() != entry->has_value)
    return wrong(text, "'" + name + (spec.value ? "' takes no value" : "' needs a value" + example));
  if (!spec.start) return wrong(text, "say when" + example);
  if (spec.since_drive) return wrong(text, "a hub knows no @drive" + example);
  if (spec.duration.has_value() != entry->lasts)
    return wrong(text, spec.duration ? "'" + name + "' takes no duration" : "say for how long" + example);

  HubFault fault{entry->kind, *spec.start, spec.duration.value_or(0), 0};
  if (entry->has_value) {
    const auto jump = bridges::parse_jump(*spec.value);
    if (!jump.ok()) return wrong(text, jump.error().message);
    fault.jump_ns = jump.value();
  }
  return fault;
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
