// Over pseudo-terminals, which behave as serial ports do but for the wire's speed.
#include "bridges/link/serial_link.hpp"

#include <array>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <pty.h>
#include <sys/ioctl.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>
#include <vector>

namespace tandem::bridges {
namespace {

using Bytes = std::vector<std::uint8_t>;
using testing::HasSubstr;

/// The far side of the cable.
struct Pty {
  Pty() {
    int slave = -1;
    std::array<char, 128> name{};
    if (openpty(&master, &slave, name.data(), nullptr, nullptr) != 0) return;
    path = name.data();
    termios raw{};
    tcgetattr(slave, &raw);
    cfmakeraw(&raw);
    tcsetattr(slave, TCSANOW, &raw);
    close(slave);
  }
  ~Pty() { unplug(); }
  void unplug() {
    if (master >= 0) close(master);
    master = -1;
  }
  std::unique_ptr<ByteLink> open() const {
    auto link = SerialLink::open({LinkScheme::Serial, path, 115200});
    EXPECT_TRUE(link.ok()) << link.error().message;
    return std::move(link).value();
  }
  int master = -1;
  std::string path;
};

Bytes read_some(ByteLink& link, std::size_t n) {
  Bytes all;
  std::array<std::uint8_t, 64> buffer;
  while (all.size() < n && link.state() == LinkState::Open) {
    if (!link.wait(5 * hal::kNsPerSecond)) break;
    const Received r = link.read(buffer);
    all.insert(all.end(), buffer.begin(), buffer.begin() + static_cast<std::ptrdiff_t>(r.size));
  }
  return all;
}

std::string error_of(const std::string& path) {
  const auto link = SerialLink::open({LinkScheme::Serial, path, 115200});
  return link.ok() ? "opened" : link.error().message;
}

TEST(SerialLink, CarriesEveryByteValueBothWays) {
  const Pty pty;
  const auto link = pty.open();
  Bytes all(256);
  for (std::size_t i = 0; i < 256; ++i) all[i] = static_cast<std::uint8_t>(i);

  EXPECT_EQ(link->write(all, hal::kNsPerSecond), 256U);
  Bytes at_master(256);
  std::size_t got = 0;
  while (got < 256) {
    const ssize_t n = ::read(pty.master, at_master.data() + got, 256 - got);
    ASSERT_GT(n, 0);
    got += static_cast<std::size_t>(n);
  }
  EXPECT_EQ(at_master, all);

  ASSERT_EQ(::write(pty.master, all.data(), all.size()), 256);
  EXPECT_EQ(read_some(*link, 256), all);
  EXPECT_EQ(link->statistics().bytes_in, 256U);
  EXPECT_EQ(link->statistics().bytes_out, 256U);
}

TEST(SerialLink, StampsBytesWithTheMonotonicClock) {
  const Pty pty;
  const auto link = pty.open();
  const hal::TimeNs before = monotonic_ns();
  ASSERT_EQ(::write(pty.master, "x", 1), 1);
  ASSERT_TRUE(link->wait(5 * hal::kNsPerSecond));
  std::array<std::uint8_t, 4> buffer;
  const Received r = link->read(buffer);
  EXPECT_EQ(r.size, 1U);
  EXPECT_GE(r.at_ns, before);
  EXPECT_LE(r.at_ns, monotonic_ns());
}

TEST(SerialLink, ReadsNothingWithoutWaitingWhenNothingCame) {
  const Pty pty;
  const auto link = pty.open();
  std::array<std::uint8_t, 4> buffer;
  EXPECT_EQ(link->read(buffer).size, 0U);
  EXPECT_FALSE(link->wait(0));
  EXPECT_EQ(link->state(), LinkState::Open);
}

TEST(SerialLink, WritesNoLongerThanItsBudgetToAPeerThatDoesNotRead) {
  const Pty pty;
  const auto link = pty.open();
  const Bytes much(1 << 20, 0x55);
  const std::size_t taken = link->write(much, 5 * hal::kNsPerMs);
  EXPECT_LT(taken, much.size());
  EXPECT_EQ(link->statistics().bytes_refused, much.size() - taken);
  EXPECT_EQ(link->state(), LinkState::Open);
}

TEST(SerialLink, SurvivesAHangUpAndItsOwnEndAfterIt) {
  Pty pty;
  auto link = pty.open();
  ASSERT_EQ(::write(pty.master, "ab", 2), 2);
  EXPECT_EQ(read_some(*link, 2), (Bytes{'a', 'b'}));
  pty.unplug();
  EXPECT_TRUE(link->wait(5 * hal::kNsPerSecond));
  std::array<std::uint8_t, 4> buffer;
  while (link->read(buffer).size > 0) {
  }
  EXPECT_EQ(link->state(), LinkState::HungUp);
  EXPECT_EQ(link->write(Bytes{1}, hal::kNsPerMs), 0U);
  EXPECT_FALSE(link->wait(0));
  EXPECT_EQ(link->statistics().errors, 1U);
  link.reset();  // LibSerial alone would end the process here
}

TEST(SerialLink, NoticesAHangUpWhileWriting) {
  Pty pty;
  const auto link = pty.open();
  pty.unplug();
  EXPECT_EQ(link->write(Bytes{1, 2}, hal::kNsPerMs), 0U);
  EXPECT_EQ(link->state(), LinkState::HungUp);
}

TEST(SerialLink, IsBusyForASecondUserAndFreeAfterwards) {
  const Pty pty;
  auto link = pty.open();
  EXPECT_THAT(error_of(pty.path), HasSubstr("in use by another program"));
  link.reset();
  EXPECT_EQ(error_of(pty.path), "opened");
}

TEST(SerialLink, IsFreeAfterwardsThoughAChildKeepsItsDescriptor) {
  const Pty pty;
  auto link = pty.open();
  const int inherited = ::dup(link->descriptor());  // as a fork does
  link.reset();
  EXPECT_EQ(error_of(pty.path), "opened");
  ::close(inherited);
}

TEST(SerialLink, LetsAGuardianSpeakBesideItsUser) {
  const Pty pty;
  const auto link = pty.open();
  int exclusive = 0;                                         // 1 would keep out whoever is not root, also a guardian
  (void)::ioctl(link->descriptor(), TIOCGEXCL, &exclusive);  // qemu's user mode does not know this request
  EXPECT_EQ(exclusive, 0);
  auto beside = SerialLink::open({LinkScheme::Serial, pty.path, 115200}, true);
  ASSERT_TRUE(beside.ok()) << beside.error().message;
  EXPECT_EQ(beside.value()->write(Bytes{'s'}, 0), 1U);
  char heard = 0;
  EXPECT_EQ(::read(pty.master, &heard, 1), 1);
  EXPECT_EQ(heard, 's');
  beside = hal::Error{"closed"};
  EXPECT_EQ(link->write(Bytes{'x'}, 0), 1U);
  EXPECT_EQ(::read(pty.master, &heard, 1), 1);
  EXPECT_EQ(heard, 'x');
  EXPECT_THAT(error_of(pty.path), HasSubstr("in use by another program"));
}

TEST(SerialLink, NamesADeviceThatIsNotThere) {
  const std::string message = error_of("/dev/ttyNoSuchRobot");
  EXPECT_THAT(message, HasSubstr("/dev/ttyNoSuchRobot"));
  EXPECT_THAT(message, HasSubstr("no such device"));
}

TEST(SerialLink, RefusesWhatIsNotATerminal) {
  EXPECT_THAT(error_of("/dev/null"), HasSubstr("not a terminal"));
  EXPECT_THAT(error_of("/"), HasSubstr("not a terminal"));
  const auto file = std::filesystem::temp_directory_path() / ("tandem_serial_" + std::to_string(getpid()));
  std::ofstream(file) << "text";
  EXPECT_THAT(error_of(file.string()), HasSubstr("not a terminal"));
  std::filesystem::remove(file);
}

TEST(SerialLink, TellsHowToGetPermission) {
  const auto file = std::filesystem::temp_directory_path() / ("tandem_serial_denied_" + std::to_string(getpid()));
  std::ofstream(file) << "text";
  std::filesystem::permissions(file, std::filesystem::perms::none);
  // As a user without privileges, in a process of its own.
  const pid_t child = fork();
  if (child == 0) {
    if (geteuid() == 0 && setuid(65534) != 0) _exit(2);
    _exit(error_of(file.string()).find("group that owns it (usually: sudo usermod -aG dialout") != std::string::npos
              ? 0
              : 1);
  }
  int status = 0;
  waitpid(child, &status, 0);
  std::filesystem::remove(file);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
}

}  // namespace
}  // namespace tandem::bridges
