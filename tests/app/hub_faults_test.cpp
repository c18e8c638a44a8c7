// Faults of the hub itself: how they are written, and that each happens once, when it is due.
#include "app/real/hub_faults.hpp"

#include <csignal>
#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

namespace tandem::app {
namespace {

using testing::HasSubstr;

constexpr hal::TimeNs kSecond = hal::kNsPerSecond;

std::string refusal(const std::string& text) {
  const auto fault = parse_hub_fault(text);
  return fault.ok() ? "taken" : fault.error().message;
}

TEST(HubFaults, AreWrittenAsThoseOfRobots) {
  const HubFault stall = parse_hub_fault("stall@5s+0.4s").value();
  EXPECT_EQ(stall.kind, HubFaultKind::Stall);
  EXPECT_EQ(stall.from, 5 * kSecond);
  EXPECT_EQ(stall.lasts, 400 * hal::kNsPerMs);
  EXPECT_EQ(parse_hub_fault("kill@2").value().from, 2 * kSecond);
  EXPECT_EQ(parse_hub_fault("clock=1h@5s").value().jump_ns, 3600 * kSecond);
  EXPECT_EQ(parse_hub_fault("clock=-90s@5s").value().jump_ns, -90 * kSecond);
}

TEST(HubFaults, AreRefusedWithAListOfThoseThatThereAre) {
  EXPECT_THAT(refusal("stal@5s+1s"), HasSubstr("there is no fault 'stal'. The faults are\n  stall@5s+0.4s"));
  EXPECT_THAT(refusal("stall@5s"), HasSubstr("say for how long, as in stall@5s+0.4s"));
  EXPECT_THAT(refusal("freeze"), HasSubstr("say when, as in freeze@5s+2s"));
  EXPECT_THAT(refusal("kill@5s+1s"), HasSubstr("'kill' takes no duration"));
  EXPECT_THAT(refusal("kill=2@5s"), HasSubstr("'kill' takes no value"));
  EXPECT_THAT(refusal("clock@5s"), HasSubstr("'clock' needs a value, as in clock=1h@5s"));
  EXPECT_THAT(refusal("clock=x@5s"), HasSubstr("hub fault 'clock=x@5s'"));
  EXPECT_THAT(refusal("kill@drive+5s"), HasSubstr("a hub knows no @drive, as in kill@5s"));
  EXPECT_FALSE(HubFaults::make({"kill@5s", "nonsense"}).ok());
}

TEST(HubFaults, HappenOnceWhenTheyAreDue) {
  HubFaults faults = HubFaults::make({"clock=2h@3s", "clock=1h@1s"}).value();
  const auto jumped_h = [before = hub_unix_ns()] { return (hub_unix_ns() - before + kSecond) / (3600 * kSecond); };
  faults.apply(100 * kSecond);
  EXPECT_EQ(jumped_h(), 0);
  faults.apply(101 * kSecond);
  EXPECT_EQ(jumped_h(), 1);
  faults.apply(102 * kSecond);
  EXPECT_EQ(jumped_h(), 1);
  faults.apply(110 * kSecond);
  EXPECT_EQ(jumped_h(), 3);
  HubFaults back = HubFaults::make({"clock=-3h@0s"}).value();
  back.apply(0);
  EXPECT_EQ(jumped_h(), 0);
}

/// What becomes of a process that meets this fault: the signal that stopped it, or 0, and its end.
struct Fate {
  int stopped_by = 0;
  int status = 0;
};
Fate fate_with(const std::string& text) {
  const pid_t hub = ::fork();
  if (hub == 0) {
    HubFaults faults = HubFaults::make({text}).value();
    faults.apply(0);
    ::_exit(7);
  }
  Fate fate;
  while (::waitpid(hub, &fate.status, WUNTRACED) == hub && WIFSTOPPED(fate.status)) {
    fate.stopped_by = WSTOPSIG(fate.status);
  }
  return fate;
}

TEST(HubFaults, StopTheWholeProcessAndHaveItGoOn) {
  const Fate fate = fate_with("freeze@0s+0.2s");
  EXPECT_EQ(fate.stopped_by, SIGSTOP);
  EXPECT_TRUE(WIFEXITED(fate.status) && WEXITSTATUS(fate.status) == 7);
}

TEST(HubFaults, KillTheProcess) {
  const Fate fate = fate_with("kill@0s");
  EXPECT_TRUE(WIFSIGNALED(fate.status) && WTERMSIG(fate.status) == SIGKILL);
}

TEST(HubFaults, KeepTheLoopWaiting) {
  timespec before{}, after{};
  ::clock_gettime(CLOCK_MONOTONIC, &before);
  HubFaults faults = HubFaults::make({"stall@0s+0.05s"}).value();
  faults.apply(0);
  faults.apply(0);
  ::clock_gettime(CLOCK_MONOTONIC, &after);
  EXPECT_GE((after.tv_sec - before.tv_sec) * kSecond + (after.tv_nsec - before.tv_nsec), 50 * hal::kNsPerMs);
}

}  // namespace
}  // namespace tandem::app
